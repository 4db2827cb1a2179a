#pragma once

#include <submap_slam/core/joined_map.h>

#include <string>

namespace submap_slam {

/** Writes a trajectory in TUM format: `t x y z qx qy qz qw`, T_w_robot, t in seconds since 1970 with 6
 * decimals.
 *
 * One line for each distinct stamp (as written, to the microsecond) in the order of first appearance; of
 * several poses with the same stamp the last one is written. Throws OutputError. */
void writeTum(const std::string& file, const Trajectory& trajectory);

}  // namespace submap_slam
