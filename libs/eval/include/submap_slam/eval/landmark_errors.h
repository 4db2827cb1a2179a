/** How far mapped landmarks and submap frames are from the truth, and whether their covariances say so. */
#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <submap_slam/core/joined_landmarks.h>
#include <submap_slam/eval/timed_trajectory.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace submap_slam {

/** D² / χ²_{n, 0.95} of an error of n dimensions with squared Mahalanobis distance D² (Combined SLAM paper,
 * eq. 20): below 1 in 95 % of all cases if the covariance is honest. */
double consistencyIndex(double distance2, unsigned dimension);

/** True positions (m) by id. */
using LandmarkTruth = std::map<uint32_t, mrpt::math::TPoint2D>;

/** Reads `id,x,y`, one landmark a line below this head; throws InputError naming file and line. */
LandmarkTruth readLandmarkTruth(const std::string& file);

/** Reads the landmarks.csv of a result; throws InputError naming file and line. */
std::vector<JoinedLandmark> readMappedLandmarks(const std::string& file);

/** How mapped landmarks find their true ones. */
enum class LandmarkMatch {
  kById,
  kByPosition  ///< nearest pairs first, one to one, up to kLandmarkGate_m; ids say nothing
};

/** Farther apart no landmark is taken for a true one by its position (m). */
constexpr double kLandmarkGate_m = 3;

struct LandmarkErrors {
  std::size_t compared = 0;  ///< landmarks with a true one
  std::size_t unknown = 0;   ///< landmarks without
  double rmse_m = 0;         ///< of the distances to the true positions
  double mean_index = 0;     ///< mean consistency index
  double mean_nees = 0;      ///< mean D², 2 is expected
};

/** Errors of mapped landmarks. By position they are those of the landmarks within the gate, so that their
 * number counts too.
 * @param T_truth_map the map frame seen from the frame of the truth; it is taken to be exact */
LandmarkErrors landmarkErrors(const std::vector<JoinedLandmark>& landmarks, const LandmarkTruth& truth,
                              const mrpt::math::TPose2D& T_truth_map, LandmarkMatch match);

/** Where a submap begins or ends. */
struct TimedFrame {
  double t = 0;                        ///< s
  mrpt::poses::CPosePDFGaussian pose;  ///< T_map_frame
};

/** Reads the frames.csv of a result; throws InputError naming file and line. */
std::vector<TimedFrame> readTimedFrames(const std::string& file);

/** One frame against the truth. */
struct FrameError {
  double t = 0;               ///< s
  mrpt::math::TPose2D error;  ///< estimate − truth in the axes of the map frame (m, rad)
  double sigma_x = 0, sigma_y = 0, sigma_phi = 0;  ///< m, m, rad
  double nees = 0;                                 ///< D², 3 is expected
  double index = 0;                                ///< consistency index
};

/** Errors of the frames that have a true pose at their time and a covariance that is positive definite (which
 * that of the first one is not). */
std::vector<FrameError> frameErrors(const std::vector<TimedFrame>& frames, const TimedTrajectory& truth,
                                    const mrpt::math::TPose2D& T_truth_map);

/** A head and one line for each. */
std::string frameErrorsCsv(const std::vector<FrameError>& errors);

/** Reads what frameErrorsCsv() made; throws InputError naming file and line. */
std::vector<FrameError> readFrameErrors(const std::string& file);

}  // namespace submap_slam
