#pragma once

#include <string>
#include <vector>

#include "experiment_columns.h"
#include "experiment_file.h"

namespace submap_slam {

/** Section [plot NAME]: a figure over settings, data or seeds. */
struct ExperimentPlot {
  std::string name, title;
  std::string x = "setting";  ///< setting, data or seed; each other combination is a series
  ExperimentColumn y;
  std::string kind = "bars";  ///< bars or lines
};

/** How the headings of plots begin. */
constexpr const char* kPlotPrefix = "plot ";

/** The sections [plot NAME] of a file; without any, a plot of each of the columns. Throws ConfigError for
 * what is unknown or missing. */
std::vector<ExperimentPlot> readPlots(const ExperimentFile& file,
                                      const std::vector<ExperimentColumn>& columns);

}  // namespace submap_slam
