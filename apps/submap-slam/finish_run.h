#pragma once

#include <submap_slam/output/output_directory.h>
#include <submap_slam/report/run_report.h>

#include <functional>
#include <string>

#include "configuration.h"
#include "metrics.h"
#include "reporter.h"
#include "stage_timer.h"

namespace submap_slam {

/** A run that makes a map. */
struct Run {
  const std::string& input;  ///< log or file of submaps
  const OutputDirectory& out;
  const Configuration& config;
  Reporter& reporter;
  const StageTimer& timer;  ///< since its start
};

/** The last stage of a run: completes the metrics, writes report.html unless [output] report is off, and at
 * the very end metrics.json. Throws OutputError.
 * @param report makes the data of the page, see runReport */
void finishRun(const Run& run, Metrics& metrics, const std::function<Metrics(const RunRecord&)>& report);

}  // namespace submap_slam
