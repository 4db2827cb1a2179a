/** How a vehicle moves that is driven by velocities, and how sure that is. */
#pragma once

#include <mrpt/math/CMatrixFixed.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/math/TTwist2D.h>
#include <submap_slam/core/parameters.h>

#include <string>

namespace submap_slam {

/** What odometry is and how wrong it is, ini section [vehicle].
 *
 * `ackermann` is a car whose pose is that of the middle of the rear axle, with a speed encoder on the left
 * rear wheel, H from the middle, and a steering sensor (Guivant, Nebot, 2001), wheel base L:
 *
 *     v = v_e / (1 − tan(g) H / L),   ω = v tan(g) / L.
 *
 * H = 0 makes it a bicycle. */
struct VehicleParams {
  std::string model = "odometry";  ///< odometry | velocity | ackermann

  double wheel_base = 2.83;      ///< L (m)
  double encoder_offset = 0.76;  ///< H (m), positive to the left

  double sigma_velocity = 0.02;                    ///< of v, with `ackermann` of v_e (m/s)
  double sigma_yaw_rate = 0.02;                    ///< of ω, with `velocity` (rad/s)
  double sigma_steering = 0.03490658503988659;     ///< of g, with `ackermann` (rad)
  double stabilising_xy = 0.2;                     ///< m/√s of each axis, while the vehicle moves
  double stabilising_turn = 0.017453292519943295;  ///< rad/√s, while the vehicle moves

  /** Whether motion follows from velocities, with a covariance. */
  bool usesVelocities() const { return model != "odometry"; }
};

/** Adds section [vehicle]. */
void describe(ParameterTable& table, VehicleParams& params);

/** Throws ConfigError if the parameters contradict each other. */
void validate(const VehicleParams& params);

/** What the sensors of a car measure. */
struct CarControl {
  double encoder_speed = 0;  ///< v_e (m/s)
  double steering = 0;       ///< g (rad), left positive
};

/** Velocities (m/s, rad/s) of the middle of the rear axle. */
mrpt::math::TTwist2D velocityOf(const CarControl& control, const VehicleParams& params);

/** What the sensors measured where a log holds velocities; their inverse. A steering angle beyond ±60°, which
 * no car has, becomes that; without speed it is 0. */
CarControl controlOf(const mrpt::math::TTwist2D& velocity, const VehicleParams& params);

/** ∂(v, ω)/∂(v_e, g). */
mrpt::math::CMatrixDouble22 velocityJacobian(const CarControl& control, const VehicleParams& params);

/** T_w_robot after moving for a time (s) with these velocities in the robot frame; midpoint rule, whose error
 * is of third order in the time. */
mrpt::math::TPose2D moved(const mrpt::math::TPose2D& T_w_robot, const mrpt::math::TTwist2D& velocity,
                          double dt);

/** Derivatives of moved(). */
struct MotionJacobians {
  mrpt::math::CMatrixDouble33 to_pose;                ///< ∂/∂(x, y, φ)
  mrpt::math::CMatrixFixed<double, 3, 2> to_control;  ///< ∂/∂(vx, ω)
};
MotionJacobians motionJacobians(const mrpt::math::TPose2D& T_w_robot, const mrpt::math::TTwist2D& velocity,
                                double dt);

/** Motion since a pose, with the covariance that follows from the noise of the controls, seen from there. */
class UncertainMotion {
 public:
  explicit UncertainMotion(const VehicleParams& params) : params_(params) { covariance_.setZero(); }

  /** Moves with constant velocities for a time dt (s). Their noise is drawn once in every `period` (s): a
   * part of a period counts in proportion, so that cutting one in two changes nothing but rounding. */
  void step(const mrpt::math::TTwist2D& velocity, double dt, double period);

  const mrpt::math::TPose2D& pose() const { return pose_; }
  const mrpt::math::CMatrixDouble33& covariance() const { return covariance_; }  ///< m², m·rad, rad²

 private:
  VehicleParams params_;
  mrpt::math::TPose2D pose_{0, 0, 0};
  mrpt::math::CMatrixDouble33 covariance_;
};

}  // namespace submap_slam
