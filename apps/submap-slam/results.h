#pragma once

#include <submap_slam/core/joined_map.h>
#include <submap_slam/output/output_directory.h>

#include <string>
#include <vector>

#include "configuration.h"

namespace submap_slam {

/** Writes the map, the trajectory and the graph in every format: map.png, map.pgm, map.yaml, map.gridmap.gz,
 * map.simplemap, map.3Dscene, trajectory.tum and graph.g2o. */
void writeResults(const OutputDirectory& out, const GridSubmaps& submaps, const JoinedMap& joined);

/** Writes how the results came about: config.ini with every effective parameter, and log.txt. */
void writeRunRecord(const OutputDirectory& out, const Configuration& config,
                    const std::vector<std::string>& log);

}  // namespace submap_slam
