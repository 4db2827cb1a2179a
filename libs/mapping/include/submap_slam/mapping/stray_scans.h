#pragma once

#include <submap_slam/mapping/local_path.h>

#include <cstddef>

namespace submap_slam {

/** So many scans in a row that fit nothing mean that the robot is somewhere else; fewer are strays. */
constexpr std::size_t kStrayScans = 2;

/** True if the scan of node k shows nothing of what the scans before it showed, although these fitted well:
 * somebody stood before the scanner, or the robot was carried. */
bool fitsNothing(const LocalPath& path, std::size_t k);

/** How many scans in a row fit nothing, the one of node k being the last of them. */
std::size_t scansThatFitNothing(const LocalPath& path, std::size_t k);

}  // namespace submap_slam
