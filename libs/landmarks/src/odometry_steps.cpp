#include "odometry_steps.h"

#include <mrpt/poses/CPose2D.h>

#include <cmath>

namespace submap_slam::landmark_mapping {
namespace {

/** Without odometry: how much faster or slower the robot may be after a step (m, rad). */
constexpr double kBlindSigmaXy = 0.3, kBlindSigmaPhi = 0.1;

Eigen::Matrix3d diagonal(double sigma_xy, double sigma_phi) {
  return Eigen::Vector3d(sigma_xy * sigma_xy, sigma_xy * sigma_xy, sigma_phi * sigma_phi).asDiagonal();
}

}  // namespace

Eigen::Matrix3d OdometrySteps::covarianceOf(const Pose& increment) const {
  const double distance = increment.head<2>().norm(), turn = std::abs(increment[2]);
  constexpr double kStill = 1e-9;
  if (distance < kStill && turn < kStill) return Eigen::Matrix3d::Zero();
  return diagonal(params_.sigma_xy + params_.sigma_xy_per_m * distance,
                  params_.sigma_phi + params_.sigma_phi_per_m * distance + params_.sigma_phi_per_rad * turn);
}

MotionStep OdometrySteps::between(const Frame& before, const Frame& now) {
  if (!before.odometry || !now.odometry) return {last_, diagonal(kBlindSigmaXy, kBlindSigmaPhi)};
  last_ = toPose(*now.odometry - *before.odometry);
  last_[2] = wrapped(last_[2]);
  return {last_,
          now.motion_covariance ? Eigen::Matrix3d(now.motion_covariance->asEigen()) : covarianceOf(last_)};
}

}  // namespace submap_slam::landmark_mapping
