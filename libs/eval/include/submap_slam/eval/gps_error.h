/** A trajectory against the positions that GPS measured. */
#pragma once

#include <mrpt/math/TPoint2D.h>
#include <submap_slam/eval/error_statistics.h>
#include <submap_slam/eval/timed_trajectory.h>
#include <submap_slam/eval/trajectory_error.h>

#include <string>
#include <vector>

namespace submap_slam {

/** Where GPS saw its antenna. */
struct GpsFix {
  double t = 0;                   ///< s
  mrpt::math::TPoint2D position;  ///< m, in a frame of its own
};

/** Reads `t x y` lines, apart by blanks; `#` starts a comment. Throws InputError naming file and line. */
std::vector<GpsFix> readGps(const std::string& file);

/** The fixes without those that are alone in the wild: farther than `max_jump` (m) from the fix before and
 * from the one behind, while these are not as far apart from each other. */
std::vector<GpsFix> withoutOutliers(const std::vector<GpsFix>& fixes, double max_jump = 50);

/** Each fix as reference, with the antenna as the trajectory has it at that time; no headings. Fixes without
 * a pose are left out.
 * @param antenna      its place on the robot (m)
 * @param max_gap_s    poses are interpolated over at most this */
std::vector<PosePair> antennaPairs(const TimedTrajectory& trajectory, const std::vector<GpsFix>& fixes,
                                   const mrpt::math::TPoint2D& antenna, double max_gap_s = 5);

struct GpsError {
  ErrorStatistics distance_m;  ///< of fixes to the antenna
  std::size_t unused = 0;      ///< fixes without a pose
};

/** Errors after the SE(2) alignment of the antenna's path that makes their squares least; parameters as those
 * of antennaPairs(). */
GpsError gpsError(const TimedTrajectory& trajectory, const std::vector<GpsFix>& fixes,
                  const mrpt::math::TPoint2D& antenna, double max_gap_s = 5);

}  // namespace submap_slam
