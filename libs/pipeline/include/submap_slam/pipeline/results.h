#pragma once

#include <submap_slam/core/joined_map.h>
#include <submap_slam/output/output_directory.h>
#include <submap_slam/pipeline/configuration.h>

#include <string>
#include <vector>

namespace submap_slam {

/** Writes what the map of the moment is looked at by: map.png, trajectory.tum, graph.g2o, frames.csv and
 * constraints.csv, each in one step, so that it is whole for whoever looks and after a kill at any time. */
void writeMapSoFar(const OutputDirectory& out, const GridSubmaps& submaps, const JoinedMap& joined);

/** Writes the map, the trajectory and the graph in every format: map.png, map.pgm, map.yaml, map.gridmap.gz,
 * map.simplemap, map.3Dscene, map.rawlog, trajectory.tum, graph.g2o, frames.csv and constraints.csv. */
void writeResults(const OutputDirectory& out, const GridSubmaps& submaps, const JoinedMap& joined);

/** Every effective parameter as an ini file. */
std::string iniOf(const Configuration& config);

/** Writes how the results came about: config.ini with every effective parameter, and log.txt. */
void writeRunRecord(const OutputDirectory& out, const Configuration& config,
                    const std::vector<std::string>& log);

}  // namespace submap_slam
