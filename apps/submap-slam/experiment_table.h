#pragma once

#include <submap_slam/eval/error_statistics.h>

#include <filesystem>
#include <string>
#include <vector>

#include "experiment.h"
#include "experiment_cells.h"

namespace submap_slam {

/** Data × setting: the cells of all seeds, in the order of the seeds. */
struct ExperimentRow {
  std::string data, setting;
  std::vector<CellResult> cells;
  std::string note;  ///< failed and missing cells

  std::size_t complete() const;

  /** Over the cells that have the figure. */
  ErrorStatistics statistics(const std::string& key) const;
};

/** What is on disk of each row. */
std::vector<ExperimentRow> readRows(const Experiment& experiment, const std::filesystem::path& folder);

/** The builds of the program that made the cells, as hashes, without repetition. */
std::vector<std::string> buildsOf(const std::vector<ExperimentRow>& rows);

/** Writes table.md and table.csv: mean and standard deviation over the seeds. Throws OutputError. */
void writeTables(const Experiment& experiment, const std::vector<ExperimentRow>& rows,
                 const std::filesystem::path& folder);

}  // namespace submap_slam
