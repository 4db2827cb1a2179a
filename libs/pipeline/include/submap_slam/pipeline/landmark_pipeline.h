/** The way from landmark submaps to a map of landmarks. */
#pragma once

#include <submap_slam/pipeline/pipeline.h>

#include <string>

namespace submap_slam {

/** Joins a file of landmark submaps (see readLandmarkSubmaps) and writes all results to a folder.
 * @param overwrite replace results in a folder that holds something */
RunSummary joinLandmarkFile(const std::string& submap_file, const std::string& folder, bool overwrite,
                            const Configuration& config, Reporter& reporter);

/** What `join` says at the end. */
std::string landmarkSummary(const RunSummary& summary, const std::string& folder);

}  // namespace submap_slam
