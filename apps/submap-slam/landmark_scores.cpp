#include "landmark_scores.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/eval/gps_error.h>
#include <submap_slam/eval/landmark_errors.h>
#include <submap_slam/eval/submap_nees.h>
#include <submap_slam/eval/trajectory_error.h>
#include <submap_slam/output/text_file.h>
#include <submap_slam/pipeline/run_files.h>
#include <submap_slam/rawlog/landmark_log.h>

#include <vector>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

void addFrameScores(Metrics& scores, const std::vector<FrameError>& errors) {
  if (errors.empty()) return;
  double nees = 0, index = 0;
  for (const FrameError& error : errors) nees += error.nees, index += error.index;
  const auto count = static_cast<double>(errors.size());
  scores["nees_frames"] = nees / count;
  scores["ci_frames"] = index / count;
}

}  // namespace

void addLandmarkScores(Metrics& scores, const OutputDirectory& out, const TimedTrajectory& estimate,
                       const TimedTrajectory& truth, const std::string& true_landmarks) {
  const auto pairs = associate(truth, estimate);
  if (pairs.empty()) throw InputError("the truth has no time in common with the trajectory");
  const TPose2D T_truth_map = pairs.front().reference + (TPose2D() - pairs.front().estimate);
  const auto frames = frameErrors(readTimedFrames(out.file("frames.csv")), truth, T_truth_map);
  addFrameScores(scores, frames);
  writeText(out.file("consistency.csv"), frameErrorsCsv(frames));
  if (true_landmarks.empty()) return;
  const LandmarkTruth landmarks = readLandmarkTruth(true_landmarks);
  const LandmarkErrors errors =
      landmarkErrors(readMappedLandmarks(out.file("landmarks.csv")), landmarks, T_truth_map);
  if (errors.compared == 0)
    throw InputError(fmt::format("{}: holds none of the mapped landmarks", true_landmarks));
  scores["landmark_rmse_m"] = errors.rmse_m;
  scores["ci_landmarks"] = errors.mean_index;
  scores["nees_landmarks"] = errors.mean_nees;
  scores["landmarks_compared"] = errors.compared;
  const SubmapNees nees =
      meanNeesPerDimension(readLandmarkSubmaps(out.file(kLandmarkFile)), landmarks, truth);
  if (nees.used > 0) scores["nees_local"] = nees.mean;
}

void addGpsScores(Metrics& scores, const TimedTrajectory& estimate, const std::string& gps_file,
                  const mrpt::math::TPoint2D& antenna) {
  const GpsError error = gpsError(estimate, withoutOutliers(readGps(gps_file)), antenna);
  if (error.distance_m.count == 0)
    throw InputError(fmt::format("{}: no time in common with the trajectory", gps_file));
  scores["gps_rmse_m"] = error.distance_m.rmse;
  scores["gps_median_m"] = error.distance_m.median;
  scores["gps_fixes"] = error.distance_m.count;
}

}  // namespace submap_slam
