#pragma once

#include <mrpt/core/Clock.h>
#include <submap_slam/core/vehicle_model.h>

#include <deque>
#include <optional>

namespace submap_slam {

/** Integrates logged velocities, each held until the next one comes, to poses and the covariance of motions
 * (rules: see RawlogReader). */
class VelocityOdometry {
 public:
  explicit VelocityOdometry(const VehicleParams& params) : params_(params) {}

  /** Takes the next reading and gives T_odom_robot at its stamp, from the identity at the first one. */
  mrpt::math::TPose2D add(mrpt::Clock::time_point stamp, const mrpt::math::TTwist2D& velocity);

  /** Covariance of the motion from one stamp to another, seen from the pose at the first; nothing if time
   * does not go forward or there is no velocity for a part of it. Readings before `from` are forgotten. */
  std::optional<mrpt::math::CMatrixDouble33> covariance(mrpt::Clock::time_point from,
                                                        mrpt::Clock::time_point to);

 private:
  struct Reading {
    mrpt::Clock::time_point stamp;
    mrpt::math::TTwist2D velocity;
  };

  VehicleParams params_;
  std::deque<Reading> readings_;
  mrpt::math::TPose2D pose_{0, 0, 0};
};

}  // namespace submap_slam
