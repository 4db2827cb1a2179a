#include "odometry_pose_graph.h"

SUBMAP_SLAM_PLUGIN()
SUBMAP_SLAM_REGISTER_JOINER(registerOdometryPoseGraph, submap_slam::OdometryPoseGraph)
