// MRPT creates objects by name when it reads a file; static registration alone is dropped by the linker.
#include <mrpt/core/initializer.h>
#include <submap_slam/core/grid_submap.h>
#include <submap_slam/core/landmark_joiner.h>
#include <submap_slam/core/landmark_submap.h>
#include <submap_slam/core/submap_joiner.h>

MRPT_INITIALIZER(registerSubmapTypes) {
  mrpt::rtti::registerClass(CLASS_ID(submap_slam::GridSubmap));
  mrpt::rtti::registerClass(CLASS_ID(submap_slam::LandmarkSubmap));
  mrpt::rtti::registerClass(CLASS_ID(submap_slam::Joiner));
  mrpt::rtti::registerClass(CLASS_ID(submap_slam::SubmapJoiner));
  mrpt::rtti::registerClass(CLASS_ID(submap_slam::LandmarkJoiner));
}
