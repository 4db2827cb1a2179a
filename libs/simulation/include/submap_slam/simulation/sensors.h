/** Sensor models: what is measured, and how wrong it is. */
#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

namespace submap_slam {

/** A 2D laser scanner that takes all beams of a scan at once. */
struct LaserModel {
  int beams = 181;                      ///< at least 2
  double aperture = 3.141592653589793;  ///< angle between the first beam and the last (rad)
  double max_range = 10.0;              ///< a beam that hits nothing nearer is invalid and reads this (m)
  double sigma_range = 0.01;            ///< standard deviation of the Gaussian range noise (m)
  double range_step = 0.001;            ///< readings are multiples of it (m); 0: not rounded
  mrpt::math::TPose2D sensor_pose{0.1, 0.0, 0.0};  ///< T_robot_sensor (m, rad)
  bool right_to_left = true;                       ///< beams counter-clockwise, as seen from above
};

/** Odometry is wrong once: a wheel drops off a door sill, the robot is pushed. */
struct OdometryJump {
  double time;                 ///< s since the start; happens in the first step that ends then or later
  mrpt::math::TPose2D offset;  ///< appended to the increment of that step, in the robot frame (m, rad)
};

/** Odometry overestimates for a while: wheels slip on the floor. */
struct WheelSlip {
  double begin, end;  ///< s since the start; steps that end in (begin, end] are affected
  double factor;      ///< measured distance / true distance
};

/** Wheel odometry: integrated increments with Gaussian noise, systematic errors and slip.
 *
 * A step with distance d (m) and turn a (rad, absolute value) has the variances
 *     along:   along² d + fixed_xy²
 *     lateral: lateral² d + fixed_xy²
 *     turn:    turn_by_distance² d + turn_by_turn² a + fixed_turn²
 * in the robot frame at the begin of the step. The terms with d and a add up to the same for any rate of
 * steps; the fixed terms (in every `fixed_every`-th step, 0 in the others) do not.
 */
struct OdometryModel {
  double along = 0.02;             ///< m/√m
  double lateral = 0.01;           ///< m/√m
  double turn_by_distance = 0.01;  ///< rad/√m
  double turn_by_turn = 0.02;      ///< rad/√rad
  double fixed_xy = 0.0002;        ///< m
  double fixed_turn = 0.0002;      ///< rad
  int fixed_every = 1;             ///< steps, at least 1

  double distance_scale = 1.0;  ///< measured distance / true distance, always
  double turn_scale = 1.0;      ///< measured turn / true turn, always
  std::vector<OdometryJump> jumps;
  std::vector<WheelSlip> slips;

  /** Odometry without any error. */
  static OdometryModel perfect();
};

/** Throw ConfigError naming the member that holds an impossible value. */
void validate(const LaserModel& laser);
void validate(const OdometryModel& odometry);

}  // namespace submap_slam
