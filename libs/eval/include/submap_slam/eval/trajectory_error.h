/** Absolute and relative error of a planar trajectory against a reference (Sturm et al., "A benchmark for the
 * evaluation of RGB-D SLAM systems", IROS 2012, in SE(2)). */
#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/eval/error_statistics.h>
#include <submap_slam/eval/timed_trajectory.h>

#include <string>
#include <vector>

namespace submap_slam {

/** Reference and estimate at the same instant, each in its own global frame (m, rad). */
struct PosePair {
  double t = 0;  ///< s
  mrpt::math::TPose2D reference, estimate;
};

/** Pairs each pose of the reference with the estimate's at that time: the nearest within `tolerance_s`, else
 * interpolated over at most `max_gap_s` (0: never). Reference poses without a partner are left out. */
std::vector<PosePair> associate(const TimedTrajectory& reference, const TimedTrajectory& estimate,
                                double tolerance_s = 1e-3, double max_gap_s = 5);

/** T_reference_estimate that minimises the sum of squared distances between reference and aligned estimate
 * positions (Umeyama, PAMI 13(4), 1991, eq. 40–42, in 2D without scale). Where the positions leave the
 * heading open (one pair, or all the same place) the mean heading difference decides. The identity for no
 * pairs. */
mrpt::math::TPose2D alignSe2(const std::vector<PosePair>& pairs);

struct TrajectoryError {
  ErrorStatistics translation_m, rotation_deg;
};

/** Absolute trajectory error after alignSe2. */
TrajectoryError absoluteTrajectoryError(const std::vector<PosePair>& pairs);

/** Relative pose error: (reference_i⁻¹ reference_{i+delta})⁻¹ (estimate_i⁻¹ estimate_{i+delta}), for every i.
 * @param delta pairs to step over, at least 1 */
TrajectoryError relativePoseError(const std::vector<PosePair>& pairs, std::size_t delta = 1);

/** Errors of single coordinates, as published for simulations: means over poses and axes. */
struct CoordinateError {
  double mae_m = 0, rmse_m = 0;      ///< of x and y in the reference's frame
  double mae_rad = 0, rmse_rad = 0;  ///< of the heading
};

/** Coordinate errors after the estimate is moved so that its first pose is that of the reference; all zero
 * for no pairs. */
CoordinateError coordinateError(const std::vector<PosePair>& pairs);

/** A table for people. */
std::string formatTable(const TrajectoryError& absolute, const TrajectoryError& relative);

}  // namespace submap_slam
