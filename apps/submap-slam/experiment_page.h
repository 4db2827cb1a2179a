#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiment.h"
#include "experiment_table.h"

namespace submap_slam {

/** Data of experiment.html, see webPage: the table, each plot, each cell with its error, and how all of it
 * was made. Seeds are texts, because the numbers of a browser do not hold all of them.
 * @param rows        of the experiment, as readRows gives them
 * @param description the experiment file with its overrides */
nlohmann::ordered_json experimentPage(const Experiment& experiment, const std::vector<ExperimentRow>& rows,
                                      const std::string& description);

}  // namespace submap_slam
