#include "experiment_columns.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

namespace submap_slam {

const std::vector<ExperimentColumn>& experimentColumns() {
  static const std::vector<ExperimentColumn> kColumns = {
      {"mae_m", "MAE, m", 4},
      {"mae_rad", "MAE, rad", 4},
      {"rmse_m", "RMSE, m", 4},
      {"rmse_rad", "RMSE, rad", 4},
      {"ate_m", "ATE, m", 4},
      {"ate_deg", "ATE, deg", 3},
      {"ape_mean_m", "APE mean, m", 4},
      {"ape_rmse_m", "APE RMSE, m", 4},
      {"ape_std_m", "APE std, m", 4},
      {"rpe_mean_m", "RPE mean, m", 5},
      {"rpe_rmse_m", "RPE RMSE, m", 5},
      {"rpe_std_m", "RPE std, m", 5},
      {"rpe_rmse_deg", "RPE RMSE, deg", 4},
      {"auc", "AUC", 4},
      {"precision", "precision", 4},
      {"recall", "recall", 4},
      {"accuracy", "accuracy", 4},
      {"coverage", "coverage", 4},
      {"final_m", "final position, m", 3},
      {"ci_frames", "CI of poses", 3},
      {"nees_frames", "NEES of poses", 3},
      {"nees_local", "local NEES/dim", 3},
      {"landmark_rmse_m", "landmarks RMSE, m", 3},
      {"ci_landmarks", "CI of landmarks", 3},
      {"nees_landmarks", "NEES of landmarks", 3},
      {"landmarks", "landmarks", 1},
      {"landmarks_compared", "landmarks compared", 1},
      {"gps_rmse_m", "GPS RMSE, m", 3},
      {"gps_median_m", "GPS median, m", 3},
      {"relations_m", "relations, m", 4},
      {"relations_deg", "relations, deg", 3},
      {"relations_rmse_m", "relations RMSE, m", 4},
      {"relations_std_m", "relations std, m", 4},
      {"local_relations_m", "local relations, m", 4},
      {"local_relations_deg", "local relations, deg", 3},
      {"constraints_accepted", "loops accepted", 1},
      {"constraints_contradicted", "loops contradicted", 1},
      {"scans", "scans", 0},
      {"submaps", "submaps", 1},
      {"key_nodes", "nodes", 0},
      {"nodes_per_submap", "nodes/submap", 1},
      {"match_score_mean", "match score", 4},
      {"match_score_min", "least score", 4},
      {"match_score_max", "greatest score", 4},
      {"stage_1", "map after stage 1", 3},
      {"stage_2", "stage 2", 3},
      {"stage_3", "stage 3", 3},
      {"stage_4", "stage 4", 3},
      {"stage_5", "stage 5", 3},
      {"build_wall_s", "submaps, s", 2},
      {"join_wall_s", "joining, s", 2},
      {"wall_s", "total, s", 2},
      {"build_cpu_s", "submaps, CPU s", 2},
      {"join_cpu_s", "joining, CPU s", 2},
      {"cpu_s", "total, CPU s", 2},
      {"join_iterations", "iterations", 1},
      {"iteration_s", "per iteration, s", 4},
      {"objective", "objective", 1},
      {"peak_memory_mb", "memory, MB", 0},
  };
  return kColumns;
}

std::string unitOf(const ExperimentColumn& column) {
  const std::size_t comma = column.label.rfind(", ");
  return comma == std::string::npos ? "" : column.label.substr(comma + 2);
}

ExperimentColumn experimentColumn(const std::string& key, const std::string& where) {
  std::vector<std::string> known;
  for (const auto& column : experimentColumns()) {
    if (column.key == key) return column;
    known.push_back(column.key);
  }
  throw ConfigError(
      fmt::format("{}: unknown column '{}'; expected some of {}", where, key, fmt::join(known, ", ")));
}

}  // namespace submap_slam
