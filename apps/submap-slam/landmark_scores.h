#pragma once

#include <mrpt/math/TPoint2D.h>
#include <submap_slam/eval/timed_trajectory.h>
#include <submap_slam/output/output_directory.h>

#include <string>

#include <submap_slam/pipeline/metrics.h>

namespace submap_slam {

/** Adds ci_frames and nees_frames, means over the poses where submaps end, and writes consistency.csv with
 * each of them; where true landmarks are given, landmark_rmse_m, ci_landmarks, nees_landmarks,
 * landmarks_compared and nees_local, the mean over submaps of their NEES per dimension. The first pose of the
 * estimate is taken to be the true one.
 * @param out             folder of a result with frames.csv, landmarks.csv and landmark_submaps.rawlog
 * @param true_landmarks  file with their true places, or empty */
void addLandmarkScores(Metrics& scores, const OutputDirectory& out, const TimedTrajectory& estimate,
                       const TimedTrajectory& truth, const std::string& true_landmarks);

/** Adds gps_rmse_m and gps_median_m of the antenna's path, aligned, and gps_fixes, their number.
 * @param antenna its place on the robot (m) */
void addGpsScores(Metrics& scores, const TimedTrajectory& estimate, const std::string& gps_file,
                  const mrpt::math::TPoint2D& antenna);

}  // namespace submap_slam
