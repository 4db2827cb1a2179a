#include "metrics.h"

namespace submap_slam {

void addLogMetrics(Metrics& metrics, const LogReport& report) {
  std::size_t scans = 0;
  for (const auto& [label, scanner] : report.scanners) scans += scanner.scans;
  metrics["scans"] = scans;
  metrics["frames"] = report.frames;
  metrics["odometry_path_m"] = report.path_length_m;
}

void addJoinMetrics(Metrics& metrics, const GridSubmaps& submaps, const JoinedMap& joined) {
  std::size_t key_nodes = 0, frames = 0, accepted = 0, rejected = 0;
  for (const auto& submap : submaps) key_nodes += submap->keyNodes(), frames += submap->nodes.size();
  for (const auto& constraint : joined.constraints)
    if (constraint.inter) ++(constraint.accepted ? accepted : rejected);
  metrics["frames"] = frames;
  metrics["key_nodes"] = key_nodes;
  metrics["submaps"] = submaps.size();
  metrics["objective"] = joined.objective;
  metrics["join_status"] = toString(joined.status);
  metrics["join_reason"] = joined.reason;
  metrics["join_iterations"] = joined.iterations.size();
  metrics["constraints_accepted"] = accepted;
  metrics["constraints_rejected"] = rejected;
}

void addTime(Metrics& metrics, const std::string& prefix, const StageTimer& timer) {
  const ElapsedTime elapsed = timer.elapsed();
  metrics[prefix + "wall_s"] = elapsed.wall_s;
  metrics[prefix + "cpu_s"] = elapsed.cpu_s;
}

}  // namespace submap_slam
