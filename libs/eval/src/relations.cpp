#include <fmt/format.h>
#include <mrpt/core/bits_math.h>
#include <submap_slam/eval/relations.h>

#include <cmath>
#include <limits>

#include "table_file.h"

namespace submap_slam {
namespace {

/** No numbers where nothing was evaluated: errors of 0 would look perfect. */
std::string tableColumns(const ErrorStatistics& e) {
  if (e.count == 0) return fmt::format("{0:>8} ± {0:<8} {0:>8} {0:>8} {0:>8}", "-");
  return fmt::format("{:>8.4f} ± {:<8.4f} {:>8.4f} {:>8.4f} {:>8.4f}", e.mean, e.std, e.median,
                     e.percentile_95, e.max);
}

std::string tableRow(const std::string& name, const RelationsResult& result) {
  return fmt::format("{:<16} {:>7} {:>8}   {}   {}\n", name, result.used, result.skipped,
                     tableColumns(result.translation_m), tableColumns(result.rotation_deg));
}

}  // namespace

std::vector<Relation> readRelations(const std::string& file) {
  std::vector<Relation> relations;
  for (const auto& [line, v] : readTable(file, "t1 t2 x y z roll pitch yaw"))
    relations.push_back({v[0], v[1], poseFromRpy(v[2], v[3], v[4], v[5], v[6], v[7])});
  return relations;
}

RelationsResult evaluateRelations(const std::vector<Relation>& relations, const TimedTrajectory& trajectory,
                                  const RelationsOptions& options) {
  RelationsResult result;
  result.total = relations.size();
  std::vector<double> translations_m, rotations_deg;
  for (const auto& relation : relations) {
    const double dt = std::abs(relation.t2 - relation.t1);
    if (dt < options.min_dt_s || dt > options.max_dt_s) {
      ++result.filtered;
      continue;
    }
    const auto T_w_1 = trajectory.at(relation.t1, options.tolerance_s, options.max_gap_s);
    const auto T_w_2 = trajectory.at(relation.t2, options.tolerance_s, options.max_gap_s);
    if (!T_w_1 || !T_w_2) {
      ++result.skipped;
      continue;
    }
    const Pose3D error = relation.T_1_2.inverse() * (T_w_1->inverse() * *T_w_2);
    translations_m.push_back(error.translation.norm());
    rotations_deg.push_back(mrpt::RAD2DEG(error.angle()));
  }
  result.used = translations_m.size();
  result.translation_m = errorStatistics(std::move(translations_m));
  result.rotation_deg = errorStatistics(std::move(rotations_deg));
  return result;
}

RelationsReport evaluateRelationsSplit(const std::vector<Relation>& relations,
                                       const TimedTrajectory& trajectory, double split_s) {
  RelationsOptions local, global;
  local.max_dt_s = split_s;
  global.min_dt_s = std::nextafter(split_s, std::numeric_limits<double>::infinity());  // not counted twice
  return {split_s, evaluateRelations(relations, trajectory), evaluateRelations(relations, trajectory, local),
          evaluateRelations(relations, trajectory, global)};
}

std::string formatTable(const RelationsReport& report) {
  const auto label = [&](const char* text) { return fmt::format("{} {:g} s", text, report.split_s); };
  return fmt::format("{:<16} {:>7} {:>8}   {:<46}   {:<46}\n", "", "", "", "translation error (m)",
                     "rotation error (deg)") +
         fmt::format(
             "{:<16} {:>7} {:>8}   {:>8} ± {:<8} {:>8} {:>8} {:>8}   {:>8} ± {:<8} {:>8} {:>8} {:>8}\n",
             "relations", "used", "skipped", "mean", "std", "median", "95 %", "max", "mean", "std", "median",
             "95 %", "max") +
         tableRow("all", report.all) + tableRow(label("local  <="), report.local) +
         tableRow(label("global >"), report.global);
}

}  // namespace submap_slam
