#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/simulation/world.h>

#include <vector>

namespace submap_slam {

/** How a simulated robot drives along way points. */
struct DriveLimits {
  double max_speed = 0.5;      ///< m/s
  double max_turn_rate = 0.7;  ///< rad/s
  double corner_radius =
      0.5;  ///< radius of the arc that rounds a corner (m), smaller where the legs are short
};

/** True robot poses at equal intervals of time. */
struct Path {
  double period = 0.2;                     ///< time between poses (s)
  std::vector<mrpt::math::TPose2D> poses;  ///< T_world_robot (m, rad); heading along the motion
};

/** Drives along way points at the highest speed the limits allow, heading along the motion.
 *
 * Corners are rounded by arcs tangential to both legs; where the route (nearly) reverses, the robot turns on
 * the spot. Speed and turn rate change in steps. The last pose is the last at a multiple of the period, at
 * most one period before the end.
 * @param way_points at least two (m), finite, no two consecutive ones equal
 * @param rate       poses per second (Hz)
 * Throws ConfigError for other way points, and for limits or a rate that are not positive and finite. */
Path drive(const WayPoints& way_points, const DriveLimits& limits, double rate);

}  // namespace submap_slam
