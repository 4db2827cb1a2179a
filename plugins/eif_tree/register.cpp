#include "eif_tree.h"

SUBMAP_SLAM_PLUGIN()
SUBMAP_SLAM_REGISTER_JOINER(registerEifTree, submap_slam::EifTree)
