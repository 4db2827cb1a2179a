#pragma once

#include <mrpt/math/TPoint2D.h>
#include <submap_slam/eval/landmark_errors.h>
#include <submap_slam/eval/submap_nees.h>
#include <submap_slam/eval/timed_trajectory.h>
#include <submap_slam/pipeline/map_forms.h>
#include <submap_slam/pipeline/metrics.h>

#include <filesystem>
#include <string>
#include <vector>

namespace submap_slam {

/** Each pose where a submap ends against the truth, beside the other files of a result. */
constexpr const char* kConsistencyFile = "consistency.csv";

/** How right a map of landmarks is and whether its covariances say so. */
struct LandmarkScores {
  std::vector<FrameError> frames;  ///< poses where submaps end
  double frame_nees = 0;           ///< mean over them; 3 is expected
  double frame_index = 0;          ///< mean over them
  LandmarkErrors landmarks;        ///< compared is 0 without true landmarks
  LandmarkMatch match{};           ///< by position where the map's ids are not those of the submaps
  SubmapNees local;                ///< of submaps in their own frames
};

/** The maps that the finished run in a folder made, by its metrics.json: other files may be left of an
 * earlier run. */
MapForms formsOf(const std::filesystem::path& folder);

/** Judges a result; the first pose of its path is taken to be the true one.
 * @param folder          a finished result of landmarks: landmarks.csv, association.csv, trajectory.tum and
 *                        frames.csv (beside grids: landmark_trajectory.tum and landmark_frames.csv)
 * @param submaps         file of the landmark submaps; empty: without local NEES
 * @param true_landmarks  file with their true places, or empty
 *
 * Throws InputError for files that do not fit together. */
LandmarkScores landmarkScores(const std::filesystem::path& folder, const std::string& submaps,
                              const TimedTrajectory& truth, const std::string& true_landmarks);

/** Adds ci_frames and nees_frames, and where true landmarks are given, landmark_rmse_m, ci_landmarks,
 * nees_landmarks, landmarks_compared and nees_local. */
void addLandmarkScores(Metrics& figures, const LandmarkScores& scores);

/** The same for people. */
std::string landmarkTable(const LandmarkScores& scores);

/** Adds gps_rmse_m and gps_median_m of the antenna's path, aligned, and gps_fixes, their number.
 * @param antenna its place on the robot (m) */
void addGpsScores(Metrics& scores, const TimedTrajectory& estimate, const std::string& gps_file,
                  const mrpt::math::TPoint2D& antenna);

}  // namespace submap_slam
