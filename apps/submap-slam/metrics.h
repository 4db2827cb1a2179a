/** The figures of a run, for metrics.json. */
#pragma once

#include <submap_slam/core/joined_map.h>
#include <submap_slam/rawlog/log_report.h>

#include <nlohmann/json.hpp>
#include <string>

#include "stage_timer.h"

namespace submap_slam {

using Metrics = nlohmann::ordered_json;

/** scans, frames, odometry_path_m */
void addLogMetrics(Metrics& metrics, const LogReport& report);

/** frames, key_nodes, submaps, objective, join_status, join_reason, join_iterations, and of the loop closures
 * that were tried constraints_accepted and constraints_rejected */
void addJoinMetrics(Metrics& metrics, const GridSubmaps& submaps, const JoinedMap& joined);

/** `<prefix>wall_s` and `<prefix>cpu_s`: time since the timer was made. */
void addTime(Metrics& metrics, const std::string& prefix, const StageTimer& timer);

}  // namespace submap_slam
