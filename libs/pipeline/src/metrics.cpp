#include <submap_slam/pipeline/metrics.h>

#include <fmt/format.h>
#include <submap_slam/core/relative_pose.h>
#include <submap_slam/core/version.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace submap_slam {

void addLogMetrics(Metrics& metrics, const LogReport& report) {
  std::size_t scans = 0;
  for (const auto& [label, scanner] : report.scanners) scans += scanner.scans;
  metrics["scans"] = scans;
  metrics["frames"] = report.frames;
  metrics["odometry_path_m"] = report.path_length_m;
}

LoopCount countLoops(const std::vector<Constraint>& constraints) {
  LoopCount count;
  for (const auto& constraint : constraints)
    if (constraint.inter) ++(constraint.accepted ? count.accepted : count.rejected);
  return count;
}

std::size_t contradictedLoops(const GridSubmaps& submaps, const JoinedMap& joined) {
  constexpr double kFar_m = 0.5, kFar_rad = 5 * M_PI / 180;
  std::map<uint32_t, mrpt::math::TPose2D> frames;
  for (std::size_t k = 0; k < submaps.size(); ++k)
    frames.emplace(submaps[k]->id, joined.frames[k].mean.asTPose());
  const auto isContradicted = [&](const Constraint& c) {
    if (!c.inter || !c.accepted || frames.count(c.from) == 0 || frames.count(c.to) == 0) return false;
    const auto e = relationError(frames[c.from], frames[c.to], c.T_a_b.mean.asTPose()).e;
    return e.head<2>().norm() > kFar_m || std::abs(e.z()) > kFar_rad;
  };
  return static_cast<std::size_t>(
      std::count_if(joined.constraints.begin(), joined.constraints.end(), isContradicted));
}

void addJoinMetrics(Metrics& metrics, const GridSubmaps& submaps, const JoinedMap& joined) {
  std::size_t key_nodes = 0, frames = 0;
  for (const auto& submap : submaps) key_nodes += submap->keyNodes(), frames += submap->nodes.size();
  const LoopCount loops = countLoops(joined.constraints);
  metrics["frames"] = frames;
  metrics["key_nodes"] = key_nodes;
  metrics["submaps"] = submaps.size();
  metrics["objective"] = joined.objective;
  metrics["join_status"] = toString(joined.status);
  metrics["join_reason"] = joined.reason;
  metrics["join_iterations"] = joined.iterations.size();
  metrics["constraints_accepted"] = loops.accepted;
  metrics["constraints_rejected"] = loops.rejected;
  metrics["constraints_contradicted"] = contradictedLoops(submaps, joined);
}

void addProgressMetrics(Metrics& metrics, const std::vector<SubmapProgress>& progress) {
  if (progress.empty()) return;
  const MatchScores scores = overallScores(progress);
  metrics["match_score_mean"] = scores.mean;
  metrics["match_score_min"] = scores.min;
  metrics["match_score_max"] = scores.max;
  metrics["nodes_per_submap"] =
      static_cast<double>(progress.back().nodes_sum) / static_cast<double>(progress.size());
  constexpr std::size_t kStages = 5;  // as many as the paper needs
  const auto shares = stageShares(progress, kStages);
  for (std::size_t s = 0; s < shares.size(); ++s) metrics[fmt::format("stage_{}", s + 1)] = shares[s];
}

void addLandmarkMetrics(Metrics& metrics, const LandmarkSubmaps& submaps, const JoinedLandmarks& joined) {
  metrics["submaps"] = submaps.size();
  metrics["features"] = joined.associations.size();
  metrics["landmarks"] = joined.landmarks.size();
  metrics["objective"] = joined.objective;
  metrics["join_status"] = toString(joined.status);
  metrics["join_reason"] = joined.reason;
  metrics["join_iterations"] = joined.iterations.size();
  metrics["association"] = joined.association_known ? "known" : "unknown";
  const bool ids_known =
      std::all_of(submaps.begin(), submaps.end(), [](const auto& submap) { return submap->ids_known; });
  if (joined.association_known || !ids_known) return;
  const AssociationErrors errors = compareWithIds(joined.associations);
  metrics["association_wrong"] = errors.wrong;
  metrics["association_missed"] = errors.missed;
  metrics["features_dropped"] = errors.dropped;
}

void addStage(Metrics& metrics, const StageRecord& stage) {
  metrics["stages"].push_back({{"name", stage.name},
                               {"wall_s", stage.time.wall_s},
                               {"cpu_s", stage.time.cpu_s},
                               {"peak_memory_mb", stage.peak_memory_mb}});
}

void addTimedStage(Metrics& metrics, const std::string& name, const StageTimer& timer) {
  addTime(metrics, name + "_", timer);
  addStage(metrics, timer.record(name));
}

void addRunMetrics(Metrics& metrics, uint64_t seed, const std::vector<std::string>& warnings,
                   const StageTimer& timer) {
  addTime(metrics, "", timer);
  metrics["peak_memory_mb"] = peakMemoryMb();
  metrics["seed"] = seed;
  metrics["version"] = version();
  metrics["warnings"] = warnings;
}

void addTime(Metrics& metrics, const std::string& prefix, const StageTimer& timer) {
  const ElapsedTime elapsed = timer.elapsed();
  metrics[prefix + "wall_s"] = elapsed.wall_s;
  metrics[prefix + "cpu_s"] = elapsed.cpu_s;
}

}  // namespace submap_slam
