#include "landmark_scores.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/eval/gps_error.h>
#include <submap_slam/eval/trajectory_error.h>
#include <submap_slam/pipeline/run_files.h>
#include <submap_slam/rawlog/landmark_log.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Only a joiner that took the ids of the submaps leaves them to the map. */
LandmarkMatch matchOf(const std::filesystem::path& associations) {
  std::ifstream in(associations);
  if (!in) throw InputError(fmt::format("{}: cannot be opened", associations.string()));
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string kind = fmt::format(",{},", toString(FeatureAssociation::Kind::kKnown));
  return text.find(kind) != std::string::npos ? LandmarkMatch::kById : LandmarkMatch::kByPosition;
}

void setFrames(LandmarkScores& scores, std::vector<FrameError> frames) {
  scores.frames = std::move(frames);
  const auto count = static_cast<double>(scores.frames.size());
  for (const FrameError& frame : scores.frames) {
    scores.frame_nees += frame.nees / count;
    scores.frame_index += frame.index / count;
  }
}

void setLandmarks(LandmarkScores& scores, const std::filesystem::path& folder, const LandmarkTruth& truth,
                  const TPose2D& T_truth_map) {
  scores.match = matchOf(folder / "association.csv");
  const auto mapped = readMappedLandmarks((folder / "landmarks.csv").string());
  scores.landmarks = landmarkErrors(mapped, truth, T_truth_map, scores.match);
}

}  // namespace

MapForms formsOf(const std::filesystem::path& folder) {
  std::ifstream in(folder / kMetricsFile);
  const auto metrics = nlohmann::json::parse(in, nullptr, false);
  return {!metrics.contains("landmarks"),
          metrics.contains("landmarks") || metrics.contains("landmark_submaps")};
}

LandmarkScores landmarkScores(const std::filesystem::path& folder, const std::string& submaps,
                              const TimedTrajectory& truth, const std::string& true_landmarks) {
  const std::filesystem::path results = folder / (formsOf(folder).grids ? "landmark_" : "");
  const auto file = [&](const char* name) { return results.string() + name; };
  const auto pairs = associate(truth, readTum(file("trajectory.tum")));
  if (pairs.empty()) throw InputError("the truth has no time in common with the trajectory");
  const TPose2D T_truth_map = pairs.front().reference + (TPose2D() - pairs.front().estimate);
  LandmarkScores scores;
  setFrames(scores, frameErrors(readTimedFrames(file("frames.csv")), truth, T_truth_map));
  if (true_landmarks.empty()) return scores;
  const LandmarkTruth landmarks = readLandmarkTruth(true_landmarks);
  setLandmarks(scores, folder, landmarks, T_truth_map);
  if (scores.landmarks.compared == 0)
    throw InputError(fmt::format("{}: holds none of the mapped landmarks", true_landmarks));
  if (!submaps.empty()) scores.local = meanNeesPerDimension(readLandmarkSubmaps(submaps), landmarks, truth);
  return scores;
}

void addLandmarkScores(Metrics& figures, const LandmarkScores& scores) {
  if (!scores.frames.empty()) {
    figures["nees_frames"] = scores.frame_nees;
    figures["ci_frames"] = scores.frame_index;
  }
  if (scores.landmarks.compared > 0) {
    figures["landmark_rmse_m"] = scores.landmarks.rmse_m;
    figures["ci_landmarks"] = scores.landmarks.mean_index;
    figures["nees_landmarks"] = scores.landmarks.mean_nees;
    figures["landmarks_compared"] = scores.landmarks.compared;
  }
  if (scores.local.used > 0) figures["nees_local"] = scores.local.mean;
}

std::string landmarkTable(const LandmarkScores& scores) {
  std::string text = "consistency           count   RMSE [m]         CI       NEES  expected\n";
  const auto add = [&](const char* what, std::size_t count, const std::string& rmse, const std::string& index,
                       double nees, int expected) {
    if (count > 0)
      text += fmt::format("{:<20} {:>6} {:>10} {:>10} {:>10.4g} {:>9}\n", what, count, rmse, index, nees,
                          expected);
  };
  const auto shown = [](double value) { return fmt::format("{:.4g}", value); };
  const LandmarkErrors& landmarks = scores.landmarks;
  add("submap ends", scores.frames.size(), "", shown(scores.frame_index), scores.frame_nees, 3);
  add(scores.match == LandmarkMatch::kById ? "landmarks by id" : "landmarks by place", landmarks.compared,
      shown(landmarks.rmse_m), shown(landmarks.mean_index), landmarks.mean_nees, 2);
  add("submaps, per element", scores.local.used, "", "", scores.local.mean, 1);
  if (landmarks.compared > 0 && landmarks.unknown > 0)
    text += fmt::format("{} landmarks have no true one\n", landmarks.unknown);
  return text;
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
