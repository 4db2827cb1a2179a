#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/math/TPose2D.h>

#include <deque>
#include <optional>

namespace submap_slam {

/** b − a in seconds. */
double secondsBetween(mrpt::Clock::time_point a, mrpt::Clock::time_point b);

/** A pose between a (share 0) and b (share 1): position linearly, heading along the shorter way. */
mrpt::math::TPose2D interpolate(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b, double share);

/** The latest odometry readings, to look up the pose at a stamp. Stamps within the track never decrease. */
class OdometryTrack {
 public:
  /** Adds a reading; returns false and leaves the track as it is if it is stamped before the last one. */
  bool add(mrpt::Clock::time_point stamp, const mrpt::math::TPose2D& pose);

  void clear() { readings_.clear(); }

  /** Stamp of the latest reading. */
  std::optional<mrpt::Clock::time_point> lastStamp() const;

  /** T_odom_robot at a stamp: interpolated between the readings before and after it; that of the last reading
   * with the very stamp; outside of the readings that of the nearest one if it is at most kHoldSeconds away,
   * else nothing. */
  std::optional<mrpt::math::TPose2D> at(mrpt::Clock::time_point stamp) const;

  static constexpr double kHoldSeconds = 1.0;

 private:
  struct Reading {
    mrpt::Clock::time_point stamp;
    mrpt::math::TPose2D pose;
  };
  static std::optional<mrpt::math::TPose2D> hold(const Reading& end, mrpt::Clock::time_point stamp);

  std::deque<Reading> readings_;
};

}  // namespace submap_slam
