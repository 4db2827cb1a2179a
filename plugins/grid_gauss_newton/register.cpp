#include "grid_gauss_newton.h"

SUBMAP_SLAM_PLUGIN()
SUBMAP_SLAM_REGISTER_JOINER(registerGridGaussNewton, submap_slam::GridGaussNewton)
