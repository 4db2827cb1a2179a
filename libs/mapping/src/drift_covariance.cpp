#include <submap_slam/mapping/drift_covariance.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

/** Even a robot that did not move is not certain of its pose: the floor of this path (m). */
constexpr double kLeastPath = 0.1;

}  // namespace

void DriftCovariance::move(const mrpt::math::TPose2D& from, const mrpt::math::TPose2D& to) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J(0, 2) = -(to.y - from.y);
  J(1, 2) = to.x - from.x;
  sum_ = J * sum_ * J.transpose();
  path_ += std::hypot(to.x - from.x, to.y - from.y);
}

void DriftCovariance::addKeyScan(const Eigen::Matrix3d& scan, const Eigen::Matrix3d& odometry) {
  const double m = params_.match_scale, o = params_.odometry_scale;
  sum_ += Eigen::Matrix3d(scan / (m * m) + odometry / (o * o)).inverse();
}

Eigen::Matrix3d DriftCovariance::covariance() const {
  const double xy = params_.sigma_xy_per_m, phi = params_.sigma_phi_per_m;
  const Eigen::Vector3d floor = Eigen::Vector3d(xy * xy, xy * xy, phi * phi) * std::max(path_, kLeastPath);
  return sum_ + Eigen::Matrix3d(floor.asDiagonal());
}

double DriftCovariance::sigmaXy() const {
  const Eigen::Matrix2d xy = covariance().topLeftCorner<2, 2>();
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(xy).eigenvalues()[1]);
}

double DriftCovariance::sigmaPhi() const { return std::sqrt(covariance()(2, 2)); }

}  // namespace submap_slam
