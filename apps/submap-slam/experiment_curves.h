#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "experiment.h"
#include "experiment_table.h"

namespace submap_slam {

/** Data of plots from the files of cells, for experimentPage(). Cells without these files are left out. Times
 * are in seconds since the start, lengths in metres, angles in degrees. */

/** Over time, curves: of each row label, t and values: mean time of the first, second, … pose where a submap
 * ends, and mean of what consistency.csv has of it; and expected: value and text of what honest covariances
 * give. */
nlohmann::ordered_json timeCurves(const ExperimentPlot& plot, const std::vector<ExperimentRow>& rows);

/** Of each row label, t, and for x, y and phi errors and sigmas of the poses where submaps end. */
nlohmann::ordered_json errorCurves(const Experiment& experiment, const ExperimentPlot& plot,
                                   const std::vector<ExperimentRow>& rows);

/** Of each data set label, fixes (of GPS), truth, and paths of all settings. Where there are fixes they are
 * paths of the antenna, each aligned with the fixes; else paths of the robot, aligned with the truth. */
nlohmann::ordered_json pathCurves(const Experiment& experiment, const ExperimentPlot& plot,
                                  const std::vector<ExperimentRow>& rows);

}  // namespace submap_slam
