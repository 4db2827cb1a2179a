#pragma once

#include <filesystem>

#include "experiment.h"

namespace submap_slam {

/** Writes table.csv and table.md into the folder of an experiment: a row for each data set and setting, each
 * figure as mean and standard deviation over the seeds. Cells that failed are left out of the means, and
 * the row says why. Returns the number of cells without a result. Throws OutputError. */
std::size_t writeTables(const Experiment& experiment, const std::filesystem::path& folder);

}  // namespace submap_slam
