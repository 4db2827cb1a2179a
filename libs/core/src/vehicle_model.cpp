#include <submap_slam/core/vehicle_model.h>

#include <fmt/format.h>
#include <mrpt/math/wrap2pi.h>
#include <submap_slam/core/errors.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::math::TTwist2D;

constexpr double kPi = 3.141592653589793;
constexpr double kMaxSteering = kPi / 3;

/** Below this a vehicle stands still (m/s, rad/s). */
constexpr double kStill = 1e-3;

/** Covariance of (v, ω) of one drawing of the controls' noise. */
Eigen::Matrix2d controlCovariance(const TTwist2D& velocity, const VehicleParams& params) {
  if (params.model != "ackermann")
    return Eigen::Vector2d(params.sigma_velocity, params.sigma_yaw_rate).cwiseAbs2().asDiagonal();
  const Eigen::Matrix2d J = velocityJacobian(controlOf(velocity, params), params).asEigen();
  const Eigen::Vector2d variances(params.sigma_velocity * params.sigma_velocity,
                                  params.sigma_steering * params.sigma_steering);
  return J * variances.asDiagonal() * J.transpose();
}

}  // namespace

void describe(ParameterTable& table, VehicleParams& params) {
  const Range kNotNegative{0};
  table.section("vehicle", "What odometry is and how wrong it is");
  table.add("model", params.model,
            "odometry: poses or increments as logged; velocity: the logged velocities, integrated; "
            "ackermann: the same of a car, whose noise is that of its encoder and its steering",
            {"odometry", "velocity", "ackermann"});
  table.add("wheel_base", params.wheel_base, "m", {0.01, 100},
            "Distance of the axles of a car (Victoria Park)");
  table.add("encoder_offset", params.encoder_offset, "m", {-10, 10},
            "How far left of the middle of the rear axle the encoder's wheel is; 0: a bicycle");
  table.add("sigma_velocity", params.sigma_velocity, "m/s", kNotNegative,
            "Standard deviation of each velocity reading, with ackermann of the encoder (Huang et al.)");
  table.add("sigma_yaw_rate", params.sigma_yaw_rate, "rad/s", kNotNegative,
            "Standard deviation of each turn rate, with velocity");
  table.add("sigma_steering", params.sigma_steering, "rad", kNotNegative,
            "Standard deviation of each steering angle, with ackermann (Huang et al.)");
  table.add("stabilising_xy", params.stabilising_xy, "m/√s", kNotNegative,
            "Further noise of each axis while the vehicle moves, for slip and a model that is not exact");
  table.add("stabilising_turn", params.stabilising_turn, "rad/√s", kNotNegative, "The same of the heading");
}

void validate(const VehicleParams& params) {
  if (std::abs(params.encoder_offset) * std::tan(kMaxSteering) >= params.wheel_base)
    throw ConfigError(
        fmt::format("[vehicle] encoder_offset = {}: must be less than 0.57 of wheel_base = {}, else the "
                    "encoder's wheel goes backwards in a sharp turn",
                    params.encoder_offset, params.wheel_base));
}

TTwist2D velocityOf(const CarControl& control, const VehicleParams& params) {
  const double curvature = std::tan(control.steering) / params.wheel_base;  // 1/m
  const double v = control.encoder_speed / (1 - curvature * params.encoder_offset);
  return {v, 0, v * curvature};
}

CarControl controlOf(const TTwist2D& velocity, const VehicleParams& params) {
  const double v = velocity.vx;
  if (v == 0) return {};
  const double steering =
      std::clamp(std::atan(params.wheel_base * velocity.omega / v), -kMaxSteering, kMaxSteering);
  return {v * (1 - std::tan(steering) * params.encoder_offset / params.wheel_base), steering};
}

mrpt::math::CMatrixDouble22 velocityJacobian(const CarControl& control, const VehicleParams& params) {
  const double L = params.wheel_base, H = params.encoder_offset;
  const double tan_g = std::tan(control.steering), dtan_g = 1 + tan_g * tan_g;
  const double k = 1 / (1 - tan_g * H / L);  // v = k v_e
  const double v = k * control.encoder_speed;
  const double dv_dg = v * k * dtan_g * H / L;
  mrpt::math::CMatrixDouble22 J;
  J(0, 0) = k;
  J(0, 1) = dv_dg;
  J(1, 0) = k * tan_g / L;
  J(1, 1) = (dv_dg * tan_g + v * dtan_g) / L;
  return J;
}

TPose2D moved(const TPose2D& T_w_robot, const TTwist2D& velocity, double dt) {
  const double middle = T_w_robot.phi + velocity.omega * dt / 2;
  const double c = std::cos(middle), s = std::sin(middle);
  return {T_w_robot.x + (c * velocity.vx - s * velocity.vy) * dt,
          T_w_robot.y + (s * velocity.vx + c * velocity.vy) * dt,
          mrpt::math::wrapToPi(T_w_robot.phi + velocity.omega * dt)};
}

MotionJacobians motionJacobians(const TPose2D& T_w_robot, const TTwist2D& velocity, double dt) {
  const double middle = T_w_robot.phi + velocity.omega * dt / 2;
  const double c = std::cos(middle), s = std::sin(middle);
  const double dx = (c * velocity.vx - s * velocity.vy) * dt, dy = (s * velocity.vx + c * velocity.vy) * dt;
  MotionJacobians J;
  J.to_pose.setIdentity();
  J.to_pose(0, 2) = -dy;
  J.to_pose(1, 2) = dx;
  J.to_control(0, 0) = c * dt;
  J.to_control(1, 0) = s * dt;
  J.to_control(2, 0) = 0;
  J.to_control(0, 1) = -dy * dt / 2;
  J.to_control(1, 1) = dx * dt / 2;
  J.to_control(2, 1) = dt;
  return J;
}

void UncertainMotion::step(const TTwist2D& velocity, double dt, double period) {
  if (!(dt > 0)) return;
  const MotionJacobians J = motionJacobians(pose_, velocity, dt);
  const Eigen::Matrix3d F = J.to_pose.asEigen();
  const Eigen::Matrix<double, 3, 2> G = J.to_control.asEigen();
  const double share = std::max(1.0, period / dt);  // n parts of a period have n times its variance each
  Eigen::Matrix3d P = F * covariance_.asEigen() * F.transpose() +
                      share * (G * controlCovariance(velocity, params_) * G.transpose());
  if (std::abs(velocity.vx) > kStill || std::abs(velocity.vy) > kStill || std::abs(velocity.omega) > kStill) {
    const double xy = params_.stabilising_xy * params_.stabilising_xy * dt;
    P.diagonal() += Eigen::Vector3d(xy, xy, params_.stabilising_turn * params_.stabilising_turn * dt);
  }
  covariance_.asEigen() = P;
  pose_ = moved(pose_, velocity, dt);
}

}  // namespace submap_slam
