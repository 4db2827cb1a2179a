#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiment_columns.h"
#include "experiment_file.h"

namespace submap_slam {

/** Section [plot NAME]: a figure over settings, data, seeds or time, errors over time or paths. */
struct ExperimentPlot {
  std::string name, title;
  std::string x;                    ///< setting, data, seed or time; each other combination is a series
  std::vector<ExperimentColumn> y;  ///< of one unit; over time one of what consistency.csv has
  std::string kind = "bars";        ///< bars, lines; without x and y: errors (with their bounds), path
  std::optional<uint64_t> seed;     ///< of errors and path; else the first one

  /** Whether it shows one seed of each setting, from the files of its cell. */
  bool ofOneSeed() const { return kind == "errors" || kind == "path"; }
};

/** How the headings of plots begin. */
constexpr const char* kPlotPrefix = "plot ";

/** The sections [plot NAME] of a file; without any, a plot of each of the columns. Throws ConfigError for
 * what is unknown or missing.
 * @param seeds of the experiment */
std::vector<ExperimentPlot> readPlots(const ExperimentFile& file,
                                      const std::vector<ExperimentColumn>& columns,
                                      const std::vector<uint64_t>& seeds);

}  // namespace submap_slam
