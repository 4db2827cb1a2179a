/** What an experiment is: data × settings × seeds, and the figures to tabulate. */
#pragma once

#include <mrpt/math/TPoint2D.h>
#include <submap_slam/simulation/scenario.h>

#include <cstdint>
#include <string>
#include <vector>

#include "experiment_columns.h"
#include "experiment_plots.h"
#include "experiment_settings.h"

namespace submap_slam {

/** Section [data NAME]: a simulated world, or a recording with something to judge the result by. */
struct ExperimentData {
  std::string name;
  std::string world;                    ///< to simulate once for each seed; empty: a recording
  std::vector<std::string> simulation;  ///< "simulation.key=value", for a world
  std::string log, truth, relations;    ///< files of a recording; truth and relations may be empty
  std::string landmarks;                ///< file with true landmarks; empty: none, or those of the world
  std::string gps;                      ///< file with fixes, or empty
  mrpt::math::TPoint2D antenna;         ///< of GPS, on the robot (m)
  std::vector<std::string> settings;    ///< "section.key=value", facts that all settings start from
};

/** An experiment file. Each combination of data, setting and seed is one cell. */
struct Experiment {
  std::string title;
  std::vector<ExperimentData> data;
  std::vector<ExperimentSetting> settings;
  std::vector<uint64_t> seeds;
  std::vector<ExperimentColumn> columns;
  std::vector<ExperimentPlot> plots;  ///< as in the file; without any, one of each column
  bool worst = false;                 ///< tables show the greatest value over the seeds too
};

/** Reads an experiment file.
 * @param overrides   "experiment.key=value"
 * @param data_folder where relative files of recordings are; empty: the folder of `file`
 *
 * Throws InputError if a file is missing, ConfigError for anything unknown or set twice, with file and line
 * where there is one, wrong settings of the pipeline and of the simulation included, so that nothing runs
 * that cannot end. */
Experiment loadExperiment(const std::string& file, const std::vector<std::string>& overrides,
                          const std::string& data_folder);

/** The text of an experiment file with the overrides in their places, so that it says the same without them.
 */
std::string effectiveDescription(const std::string& file, const std::vector<std::string>& overrides);

}  // namespace submap_slam
