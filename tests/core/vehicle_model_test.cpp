#include <gmock/gmock.h>
#include <mrpt/math/wrap2pi.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/vehicle_model.h>

#include <Eigen/Core>
#include <cmath>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::math::TTwist2D;

VehicleParams car() {
  VehicleParams params;
  params.model = "ackermann";
  return params;
}

/** Noise of the controls alone. */
VehicleParams withoutStabilisingNoise(VehicleParams params) {
  params.stabilising_xy = params.stabilising_turn = 0;
  return params;
}

Eigen::Vector3d vectorOf(const TPose2D& pose) { return {pose.x, pose.y, pose.phi}; }

TEST(VehicleModel, LeftWheelIsSlowerInALeftTurn) {
  // tan(45°) = 1: a turn of radius L = 2 m around a point at the left; the wheel at 0.5 m has radius 1.5 m
  VehicleParams params = car();
  params.wheel_base = 2;
  params.encoder_offset = 0.5;
  const TTwist2D v = velocityOf({1.5, M_PI / 4}, params);
  EXPECT_NEAR(v.vx, 2, 1e-12);
  EXPECT_NEAR(v.omega, 1, 1e-12);
  EXPECT_NEAR(velocityOf({2.5, -M_PI / 4}, params).vx, 2, 1e-12);
  EXPECT_NEAR(velocityOf({3, 0}, params).vx, 3, 1e-12);
}

TEST(VehicleModel, ControlIsTheInverseOfVelocity) {
  for (const double speed : {-2.0, 0.3, 4.0})
    for (const double steering : {-0.6, -0.01, 0.0, 0.4}) {
      const CarControl control = controlOf(velocityOf({speed, steering}, car()), car());
      EXPECT_NEAR(control.encoder_speed, speed, 1e-12);
      EXPECT_NEAR(control.steering, steering, 1e-12);
    }
  EXPECT_EQ(controlOf({0, 0, 0.1}, car()).steering, 0);
  EXPECT_NEAR(controlOf({0.001, 0, 5}, car()).steering, M_PI / 3, 1e-12);
}

TEST(VehicleModel, VelocityJacobianIsTheDerivative) {
  const double h = 1e-6;
  for (const double steering : {-0.5, 0.0, 0.3}) {
    const CarControl control{3, steering};
    const auto J = velocityJacobian(control, car());
    const auto difference = [&](double dv, double dg) {
      const TTwist2D a = velocityOf({3 + dv, steering + dg}, car());
      const TTwist2D b = velocityOf({3 - dv, steering - dg}, car());
      return Eigen::Vector2d((a.vx - b.vx) / (2 * h), (a.omega - b.omega) / (2 * h));
    };
    EXPECT_LT((J.asEigen().col(0) - difference(h, 0)).norm(), 1e-8);
    EXPECT_LT((J.asEigen().col(1) - difference(0, h)).norm(), 1e-8);
  }
}

TEST(VehicleModel, MotionJacobiansAreTheDerivatives) {
  const double h = 1e-6;
  const TPose2D T(1, 2, 0.7);
  const TTwist2D v(3, 0.2, 0.4);
  const auto J = motionJacobians(T, v, 0.5);
  const auto difference = [&](const Eigen::Vector3d& pose, const Eigen::Vector2d& control) {
    const auto at = [&](double sign) {
      const Eigen::Vector3d p = vectorOf(T) + sign * pose;
      return vectorOf(
          moved({p.x(), p.y(), p.z()}, {v.vx + sign * control.x(), v.vy, v.omega + sign * control.y()}, 0.5));
    };
    return Eigen::Vector3d((at(1) - at(-1)) / (2 * h));
  };
  for (int i = 0; i < 3; ++i)
    EXPECT_LT((J.to_pose.asEigen().col(i) - difference(h * Eigen::Vector3d::Unit(i), {0, 0})).norm(), 1e-8);
  for (int i = 0; i < 2; ++i)
    EXPECT_LT((J.to_control.asEigen().col(i) - difference({0, 0, 0}, h * Eigen::Vector2d::Unit(i))).norm(),
              1e-8);
}

TEST(VehicleModel, DrivesACircle) {
  TPose2D pose(0, 0, 0);
  for (int k = 0; k < 1000; ++k) pose = moved(pose, {1, 0, 0.5}, M_PI / 250);  // radius 2 m, once around
  EXPECT_LT(std::hypot(pose.x, pose.y), 1e-9);
  for (int k = 0; k < 500; ++k) pose = moved(pose, {1, 0, 0.5}, M_PI / 250);
  EXPECT_NEAR(pose.y, 4, 1e-4);
  EXPECT_NEAR(moved({0, 0, M_PI / 2}, {0, 1, 0}, 2).x, -2, 1e-12);
}

TEST(UncertainMotion, HandWorkedStraightStep) {
  // 2 m/s for 0.1 s with σ_v = 0.5 and σ_g = 0.1, L = 4: σ_x = 0.05 m; σ_ω = 2 · 0.1 / 4 = 0.05 rad/s
  VehicleParams params = withoutStabilisingNoise(car());
  params.wheel_base = 4;
  params.encoder_offset = 0;
  params.sigma_velocity = 0.5;
  params.sigma_steering = 0.1;
  UncertainMotion motion(params);
  motion.step({2, 0, 0}, 0.1, 0.1);
  const auto& P = motion.covariance();
  EXPECT_NEAR(P(0, 0), 0.0025, 1e-12);
  EXPECT_NEAR(P(2, 2), 0.000025, 1e-12);
  EXPECT_NEAR(P(1, 2), 0.1 * 0.000025, 1e-12);  // the middle of the step turns it sideways by 0.1 m · δφ
  EXPECT_NEAR(P(1, 1), 0.01 * 0.000025, 1e-12);
  EXPECT_NEAR(P(0, 1), 0, 1e-15);
}

TEST(UncertainMotion, CuttingStepsChangesLittle) {
  const VehicleParams params = car();
  const TTwist2D v(4, 0, 0.3);
  UncertainMotion whole(params), cut(params);
  for (int k = 0; k < 40; ++k) {
    whole.step(v, 0.025, 0.025);
    cut.step(v, 0.01, 0.025);
    cut.step(v, 0.015, 0.025);
  }
  EXPECT_LT((whole.covariance().asEigen() - cut.covariance().asEigen()).norm(),
            0.01 * whole.covariance().asEigen().norm());
  EXPECT_NEAR(whole.pose().x, cut.pose().x, 1e-4);
}

TEST(UncertainMotion, IsTheSpreadOfNoisyMotions) {
  // linear in small noise: the covariance is the sum over the sources of (end − undisturbed end)²
  const VehicleParams params = withoutStabilisingNoise(car());
  const TTwist2D v(4, 0, 0.3);
  const CarControl control = controlOf(v, params);
  const int steps = 12;
  const double dt = 0.025, small = 1e-4;
  const auto end = [&](int disturbed, double speed, double steering) {
    TPose2D pose(0, 0, 0);
    for (int k = 0; k < steps; ++k)
      pose = moved(pose,
                   k == disturbed
                       ? velocityOf({control.encoder_speed + speed, control.steering + steering}, params)
                       : v,
                   dt);
    return vectorOf(pose);
  };
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  for (int k = 0; k < steps; ++k) {
    const Eigen::Vector3d a = (end(k, small, 0) - end(-1, 0, 0)) / small * params.sigma_velocity;
    const Eigen::Vector3d b = (end(k, 0, small) - end(-1, 0, 0)) / small * params.sigma_steering;
    expected += a * a.transpose() + b * b.transpose();
  }
  UncertainMotion motion(params);
  for (int k = 0; k < steps; ++k) motion.step(v, dt, dt);
  EXPECT_LT((motion.covariance().asEigen() - expected).norm(), 1e-3 * expected.norm());
}

TEST(UncertainMotion, NothingHappensStandingStill) {
  VehicleParams params = car();
  UncertainMotion motion(params);
  for (int k = 0; k < 40; ++k) motion.step({0, 0, 0}, 0.025, 0.025);
  EXPECT_EQ(motion.covariance()(2, 2), 0);  // no speed, no turn; only the encoder may err
  EXPECT_GT(motion.covariance()(0, 0), 0);
  motion.step({1, 0, 0}, 0, 0.025);
  EXPECT_EQ(motion.pose().x, 0);
}

TEST(UncertainMotion, StabilisingNoiseIsThatPerSecond) {
  VehicleParams params;
  params.model = "velocity";
  params.sigma_velocity = params.sigma_yaw_rate = 0;
  UncertainMotion motion(params);
  for (int k = 0; k < 40; ++k) motion.step({0, 0, 0.1}, 0.025, 0.025);
  EXPECT_NEAR(motion.covariance()(0, 0), 0.04, 1e-12);
  EXPECT_NEAR(motion.covariance()(2, 2), std::pow(M_PI / 180, 2), 1e-12);
}

TEST(VehicleParams, EncoderMustBeInsideTheTurn) {
  VehicleParams params = car();
  EXPECT_NO_THROW(validate(params));
  params.encoder_offset = -2;
  EXPECT_THROW(validate(params), ConfigError);
}

}  // namespace
}  // namespace submap_slam
