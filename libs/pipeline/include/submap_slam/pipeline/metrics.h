/** The figures of a run, for metrics.json. */
#pragma once

#include <submap_slam/core/joined_landmarks.h>
#include <submap_slam/eval/mapping_progress.h>
#include <submap_slam/pipeline/stage_timer.h>
#include <submap_slam/rawlog/log_report.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace submap_slam {

using Metrics = nlohmann::ordered_json;

/** scans, frames, odometry_path_m */
void addLogMetrics(Metrics& metrics, const LogReport& report);

/** Loop closures that were tried. */
struct LoopCount {
  std::size_t accepted = 0, rejected = 0;
};
LoopCount countLoops(const std::vector<Constraint>& constraints);

/** Accepted loop closures whose frames ended up more than 0.5 m or 5° from where the closure has them: either
 * it is false or the map is. */
std::size_t contradictedLoops(const GridSubmaps& submaps, const JoinedMap& joined);

/** frames, key_nodes, submaps, objective, join_status, join_reason, join_iterations, and of the loop closures
 * that were tried constraints_accepted, constraints_rejected and constraints_contradicted */
void addJoinMetrics(Metrics& metrics, const GridSubmaps& submaps, const JoinedMap& joined);

/** match_score_mean, match_score_min, match_score_max, nodes_per_submap, and stage_1 … stage_5: share of the
 * map after each fifth of the submaps. What has no submaps is left out. */
void addProgressMetrics(Metrics& metrics, const std::vector<SubmapProgress>& progress);

/** submaps, features, landmarks, objective, join_status, join_reason, join_iterations, association; and where
 * it ignored the ids, how it compares with them: association_wrong, association_missed, features_dropped */
void addLandmarkMetrics(Metrics& metrics, const LandmarkSubmaps& submaps, const JoinedLandmarks& joined);

/** An entry of `stages`: name, wall_s, cpu_s, peak_memory_mb. */
void addStage(Metrics& metrics, const StageRecord& stage);

/** addTime, and an entry of `stages`. */
void addTimedStage(Metrics& metrics, const std::string& name, const StageTimer& timer);

/** What every run ends with: its times, peak_memory_mb, seed, version, warnings. */
void addRunMetrics(Metrics& metrics, uint64_t seed, const std::vector<std::string>& warnings,
                   const StageTimer& timer);

/** `<prefix>wall_s` and `<prefix>cpu_s`: time since the timer was made. */
void addTime(Metrics& metrics, const std::string& prefix, const StageTimer& timer);

}  // namespace submap_slam
