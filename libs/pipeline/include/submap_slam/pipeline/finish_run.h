#pragma once

#include <submap_slam/core/joined_map.h>
#include <submap_slam/output/output_directory.h>
#include <submap_slam/pipeline/configuration.h>
#include <submap_slam/pipeline/metrics.h>
#include <submap_slam/pipeline/reporter.h>
#include <submap_slam/pipeline/stage_timer.h>
#include <submap_slam/report/run_report.h>

#include <functional>
#include <string>

namespace submap_slam {

/** A run that makes a map. */
struct Run {
  const std::string& input;  ///< log or file of submaps
  const OutputDirectory& out;
  const Configuration& config;
  Reporter& reporter;
  const StageTimer& timer;  ///< since its start
};

/** Makes the data of report.html, see runReport. */
using ReportMaker = std::function<Metrics(const RunRecord&)>;

/** A map that is joined and written. */
struct FinishedMap {
  Trajectory path;
  ReportMaker report;
};

/** The last stage of a run: writes the record of the run, completes the metrics, writes report.html unless
 * [output] report is off, and at the very end metrics.json. Throws OutputError. */
void finishRun(const Run& run, Metrics& metrics, const ReportMaker& report);

}  // namespace submap_slam
