#include "cell_scores.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/eval/grid_scores.h>
#include <submap_slam/eval/relations.h>
#include <submap_slam/eval/trajectory_error.h>

#include <cmath>
#include <limits>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

std::vector<PosePair> pairsOf(const TimedTrajectory& estimate, const TimedTrajectory& truth) {
  auto pairs = associate(truth, estimate);
  if (pairs.empty()) throw InputError("the truth has no time in common with the trajectory");
  return pairs;
}

std::optional<TPose2D> poseAt(const TimedTrajectory& trajectory, const Frame& frame) {
  const auto pose = trajectory.at(mrpt::Clock::toDouble(frame.stamp));
  if (!pose) return {};
  return toPose2D(*pose);
}

void addStatistics(Metrics& scores, const std::string& name, const ErrorStatistics& error_m) {
  scores[name + "_mean_m"] = error_m.mean;
  scores[name + "_rmse_m"] = error_m.rmse;
  scores[name + "_std_m"] = error_m.std;
}

}  // namespace

std::vector<Frame> readFrames(const std::string& log, const ReaderParams& params) {
  RawlogReader reader(log, params);
  std::vector<Frame> frames;
  while (auto frame = reader.next()) frames.push_back(std::move(*frame));
  return frames;
}

EvidenceGrid mapFromPoses(const std::vector<Frame>& frames, const TimedTrajectory& trajectory,
                          const TPose2D& T_map_w, const GridMapperParams& params) {
  const double max_range = params.max_range > 0 ? params.max_range : std::numeric_limits<double>::max();
  std::vector<LaserPoints> scans;
  std::vector<TPose2D> poses;
  for (const Frame& frame : frames)
    if (const auto T_w_robot = poseAt(trajectory, frame)) {
      scans.push_back(toLaserPoints(frame, max_range));
      poses.push_back(T_map_w + *T_w_robot);
    }
  std::vector<PlacedScan> placed;
  for (std::size_t i = 0; i < scans.size(); ++i) placed.push_back({&scans[i], poses[i]});
  return renderEvidence(placed, params.evidence);
}

void addPoseScores(Metrics& scores, const TimedTrajectory& estimate, const TimedTrajectory& truth) {
  const auto pairs = pairsOf(estimate, truth);
  const CoordinateError error = coordinateError(pairs);
  scores["mae_m"] = error.mae_m;
  scores["mae_rad"] = error.mae_rad;
  scores["rmse_m"] = error.rmse_m;
  scores["rmse_rad"] = error.rmse_rad;
  const TPose2D end =
      (pairs.front().reference + (TPose2D() - pairs.front().estimate)) + pairs.back().estimate;
  scores["final_m"] = std::hypot(end.x - pairs.back().reference.x, end.y - pairs.back().reference.y);
  const TrajectoryError absolute = absoluteTrajectoryError(pairs);
  scores["ate_m"] = absolute.translation_m.rmse;
  scores["ate_deg"] = absolute.rotation_deg.rmse;
  addStatistics(scores, "ape", absolute.translation_m);
  const TrajectoryError relative = relativePoseError(pairs);
  addStatistics(scores, "rpe", relative.translation_m);
  scores["rpe_rmse_deg"] = relative.rotation_deg.rmse;
}

void addMapScores(Metrics& scores, const EvidenceGrid& map, const TimedTrajectory& estimate,
                  const TimedTrajectory& truth, const std::vector<Frame>& frames,
                  const GridMapperParams& params) {
  const PosePair first = pairsOf(estimate, truth).front();
  const TPose2D T_map_w = first.estimate + (TPose2D() - first.reference);
  const GridScores grid = scoreGrid(map, mapFromPoses(frames, truth, T_map_w, params));
  const auto add = [&](const char* key, const std::optional<double>& value) {
    if (value) scores[key] = *value;
  };
  add("auc", grid.auc);
  add("precision", grid.precision);
  add("recall", grid.recall);
  add("accuracy", grid.accuracy);
  scores["coverage"] = grid.coverage;
}

void addRelationScores(Metrics& scores, const TimedTrajectory& estimate, const std::string& relations_file) {
  const RelationsReport report = evaluateRelationsSplit(readRelations(relations_file), estimate);
  if (report.all.used == 0)
    throw InputError(fmt::format("{}: no relation that the trajectory covers", relations_file));
  scores["relations_m"] = report.all.translation_m.mean;
  scores["relations_rmse_m"] = report.all.translation_m.rmse;
  scores["relations_std_m"] = report.all.translation_m.std;
  scores["relations_deg"] = report.all.rotation_deg.mean;
  scores["local_relations_m"] = report.local.translation_m.mean;
  scores["local_relations_deg"] = report.local.rotation_deg.mean;
}

}  // namespace submap_slam
