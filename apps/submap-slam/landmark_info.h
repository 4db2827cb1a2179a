#pragma once

#include <submap_slam/core/landmark_submap.h>

namespace submap_slam {

/** Prints a table of landmark submaps and their sums. */
void printLandmarkSubmaps(const LandmarkSubmaps& submaps);

}  // namespace submap_slam
