#include <submap_slam/report/comparison.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "report_parts.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Rows in the order in which their names first appear in any run. */
class RowCollector {
 public:
  explicit RowCollector(std::size_t runs) : runs_(runs) {}

  void set(std::size_t run, const std::string& name, Json value) {
    const auto [entry, is_new] = index_.emplace(name, rows_.size());
    if (is_new) rows_.push_back({name, std::vector<Json>(runs_)});
    rows_[entry->second].values[run] = std::move(value);
  }

  std::vector<ComparisonRow> take() { return std::move(rows_); }

 private:
  std::size_t runs_;
  std::vector<ComparisonRow> rows_;
  std::map<std::string, std::size_t> index_;
};

bool isResource(const std::string& key) {
  const auto endsWith = [&](const std::string& end) {
    return key.size() >= end.size() && key.compare(key.size() - end.size(), end.size(), end) == 0;
  };
  return endsWith("wall_s") || endsWith("cpu_s") || key == "peak_memory_mb";
}

ComparisonTable figures(const std::vector<RunFolder>& runs) {
  RowCollector rows(runs.size());
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (const auto& [key, value] : runs[k].metrics.items()) {
      if (key == "warnings") rows.set(k, "warnings", value.size());
      if (value.is_primitive() && !isResource(key)) rows.set(k, key, value);
    }
  return {"Figures", rows.take()};
}

bool isNamedStage(const Json& stage) {
  return stage.is_object() && stage.contains("name") && stage["name"].is_string() && stage.contains("cpu_s");
}

ComparisonTable resources(const std::vector<RunFolder>& runs) {
  RowCollector rows(runs.size());
  for (std::size_t k = 0; k < runs.size(); ++k) {
    for (const auto& [key, value] : runs[k].metrics.items())
      if (value.is_number() && isResource(key)) rows.set(k, key, value);
    const Json stages = runs[k].metrics.value("stages", Json::array());
    for (const Json& stage : stages)
      if (isNamedStage(stage) && !runs[k].metrics.contains(stage["name"].get<std::string>() + "_cpu_s"))
        rows.set(k, stage["name"].get<std::string>() + "_cpu_s", stage["cpu_s"]);
  }
  return {"Time and memory", rows.take()};
}

/** Keys that have not the same value in all runs. */
ComparisonTable settings(const std::vector<RunFolder>& runs) {
  RowCollector rows(runs.size());
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (const IniEntry& entry : runs[k].settings)
      if (!entry.key.empty()) rows.set(k, entry.section + "." + entry.key, entry.value);
  auto all = rows.take();
  const auto isTheSame = [](const ComparisonRow& row) {
    return std::all_of(row.values.begin(), row.values.end(),
                       [&](const Json& v) { return v == row.values[0]; });
  };
  all.erase(std::remove_if(all.begin(), all.end(), isTheSame), all.end());
  return {"Settings that differ", all};
}

SeenFromReference seenFrom(const TimedTrajectory& reference, const TimedTrajectory& run) {
  constexpr double kTolerance_s = 1e-3, kMaxGap_s = 5;
  SeenFromReference seen;
  for (const TimedPose& first : run.poses())
    if (const auto T_ref_robot = reference.at(first.t, kTolerance_s, kMaxGap_s)) {
      seen.T_ref_w = toPose2D(*T_ref_robot * first.pose.inverse());
      break;
    }
  seen.pairs = associate(reference, run, kTolerance_s, kMaxGap_s);
  for (PosePair& pair : seen.pairs) pair.estimate = seen.T_ref_w + pair.estimate;
  return seen;
}

double distance(const PosePair& pair) {
  return std::hypot(pair.estimate.x - pair.reference.x, pair.estimate.y - pair.reference.y);
}

double turn_deg(const PosePair& pair) {
  return degrees(std::abs(mrpt::math::wrapToPi(pair.estimate.phi - pair.reference.phi)));
}

double length(const TimedTrajectory& trajectory) {
  double sum = 0;
  for (std::size_t i = 1; i < trajectory.poses().size(); ++i)
    sum += (trajectory.poses()[i].pose.translation - trajectory.poses()[i - 1].pose.translation).norm();
  return sum;
}

void addDifferences(RowCollector& rows, std::size_t run, const std::vector<PosePair>& pairs) {
  std::vector<double> distances, turns;
  for (const PosePair& pair : pairs) distances.push_back(distance(pair)), turns.push_back(turn_deg(pair));
  const ErrorStatistics d = errorStatistics(distances), t = errorStatistics(turns);
  rows.set(run, "common_poses", d.count);
  if (d.count == 0) return;
  rows.set(run, "apart_mean_m", d.mean);
  rows.set(run, "apart_rmse_m", d.rmse);
  rows.set(run, "apart_max_m", d.max);
  rows.set(run, "turned_mean_deg", t.mean);
  rows.set(run, "turned_max_deg", t.max);
  rows.set(run, "apart_rmse_best_fit_m", absoluteTrajectoryError(pairs).translation_m.rmse);
}

ComparisonTable trajectories(const std::vector<RunFolder>& runs, const std::vector<SeenFromReference>& seen) {
  RowCollector rows(runs.size());
  for (std::size_t k = 0; k < runs.size(); ++k) {
    rows.set(k, "poses", runs[k].trajectory.poses().size());
    rows.set(k, "path_m", length(runs[k].trajectory));
    if (k > 0) addDifferences(rows, k, seen[k].pairs);
  }
  return {"Trajectories, differences from the first run", rows.take()};
}

}  // namespace

Comparison compareRuns(const std::vector<RunFolder>& runs, const std::vector<std::string>& names) {
  Comparison comparison;
  comparison.names = names;
  for (std::size_t k = 0; k < runs.size(); ++k)
    comparison.seen.push_back(k == 0 ? SeenFromReference{}
                                     : seenFrom(runs[0].trajectory, runs[k].trajectory));
  comparison.tables = {figures(runs), resources(runs), trajectories(runs, comparison.seen), settings(runs)};
  return comparison;
}

}  // namespace submap_slam
