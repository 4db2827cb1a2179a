#pragma once

#include <submap_slam/core/joined_map.h>

#include <cstddef>
#include <string>
#include <vector>

namespace submap_slam {

/** True if the end pose of a submap says too little of where the next one is: scans and odometry contradict
 * each other there (σ of at least 0.1 m or 0.05 rad), or the log has a gap. */
bool endIsDoubtful(const GridSubmap& submap);

/** Submaps before which the map may be broken: the end before is doubtful, and no accepted loop closure nor
 * constraint by hand links what is before to what is behind.
 * @return positions in `submaps`, ascending */
std::vector<std::size_t> breaksOf(const GridSubmaps& submaps, const std::vector<Constraint>& constraints);

/** The same in words, with the ids of the submaps; empty if there is none. */
std::string describeBreaks(const GridSubmaps& submaps, const std::vector<Constraint>& constraints);

}  // namespace submap_slam
