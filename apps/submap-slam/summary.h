#pragma once

#include <submap_slam/pipeline/pipeline.h>

#include <string>

#include "common_options.h"

namespace submap_slam {

/** What `map` and `join` say at their end: where the map is and the main figures, or how to go on. */
std::string mapSummary(const RunSummary& summary, const std::string& folder);

/** The same where only landmarks were mapped. */
std::string landmarkSummary(const RunSummary& summary, const std::string& folder);

/** The same for `build`. */
std::string buildSummary(const RunSummary& summary, const std::string& submap_file);

ExitCode exitCodeOf(const RunSummary& summary);

}  // namespace submap_slam
