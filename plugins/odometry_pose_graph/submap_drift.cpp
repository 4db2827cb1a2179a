#include "submap_drift.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace submap_slam::pose_graph {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using mrpt::math::TPose2D;

/** Nothing is known better than that over a length. */
constexpr double kLeastXy_m = 1e-4, kLeastPhi_rad = 1e-5;

/** A covariance in the axes of a submap, as seen by a pose in it. */
Matrix3d turnedTo(const TPose2D& T_s_a, const Matrix3d& covariance) {
  Matrix3d R = Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-T_s_a.phi).toRotationMatrix();
  return R * covariance * R.transpose();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

SubmapDrift::SubmapDrift(const Matrix3d& end_covariance, double length)
    : phi_(std::max(end_covariance(2, 2) / length, kLeastPhi_rad * kLeastPhi_rad)),
      end_covariance_(end_covariance),
      last_step_(Matrix3d::Zero()) {
  // What turns on the way move the end by goes with its heading, and comes again with the turns.
  const Vector2d with_phi = end_covariance.block<2, 1>(0, 2);
  const Matrix2d by_turns = with_phi * with_phi.transpose() / (phi_ * length);
  xy_ = (end_covariance.topLeftCorner<2, 2>() - by_turns) / length +
        kLeastXy_m * kLeastXy_m * Matrix2d::Identity();
}

void SubmapDrift::limit(const DriftRate& usual) {
  const double share = std::min({1.0, usual.xy / rate().xy, usual.phi / phi_});
  last_step_ = (1 - share) * end_covariance_;
  xy_ *= share;
  phi_ *= share;
}

Matrix3d SubmapDrift::over(double length, const TPose2D& T_s_a) const {
  Matrix3d covariance = Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() = length * xy_;
  covariance(2, 2) = length * phi_;
  return turnedTo(T_s_a, covariance);
}

Matrix3d SubmapDrift::overLast(double length, const TPose2D& T_s_a) const {
  return over(length, T_s_a) + turnedTo(T_s_a, last_step_);
}

DriftRate medianOf(const std::vector<DriftRate>& rates) {
  if (rates.empty()) return {};
  std::vector<double> xy, phi;
  for (const DriftRate& rate : rates) {
    xy.push_back(rate.xy);
    phi.push_back(rate.phi);
  }
  return {median(xy), median(phi)};
}

}  // namespace submap_slam::pose_graph
