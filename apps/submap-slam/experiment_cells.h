/** Runs the cells of an experiment, each in a folder and a process of its own. */
#pragma once

#include <submap_slam/pipeline/reporter.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "experiment.h"

namespace submap_slam {

/** How the run of an experiment uses the machine. */
struct ExperimentRun {
  std::filesystem::path folder;  ///< data/ gets the simulated logs, cells/DATA/SETTING/SEED/ the results
  int jobs = 1;                  ///< cells at a time
  int threads = 0;               ///< of each cell; 0: an equal share of the machine's
  bool any_build = false;        ///< keep what another build of the same version has done
};

/** What is known of a cell. */
struct CellResult {
  std::map<std::string, double>
      figures;        ///< by the keys of experimentColumns(); what does not apply is missing
  std::string error;  ///< why there are none; empty also if the cell has not run
  std::string build;  ///< hash of the program that ran it
  std::string mrpt;   ///< version of MRPT that it ran with
  std::filesystem::path folder;
  std::string truth;  ///< file with the true path, or empty

  /** Why there are no figures; empty if there are. */
  std::string failure() const;
};

/** Names of the cells with "complete" or "to do", one a line. */
std::string listCells(const Experiment& experiment, const ExperimentRun& run);

/** Runs all cells that have no complete result of the same program, data and parameters yet. Returns false if
 * a stop signal ended it early. */
bool runCells(const Experiment& experiment, const ExperimentRun& run, Reporter& reporter);

/** The result of a cell as it is on disk. */
CellResult readCell(const std::filesystem::path& experiment_folder, const ExperimentData& data,
                    const ExperimentSetting& setting, uint64_t seed);

}  // namespace submap_slam
