#include <submap_slam/core/landmark_joiner.h>
#include <submap_slam/core/submap_joiner.h>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Joiner, mrpt::rtti::CObject, submap_slam)
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(SubmapJoiner, submap_slam::Joiner, submap_slam)
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(LandmarkJoiner, submap_slam::Joiner, submap_slam)
