#include <submap_slam/core/relative_pose.h>

#include <mrpt/math/wrap2pi.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <cmath>

namespace submap_slam {

RelationError relationError(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b,
                            const mrpt::math::TPose2D& T_a_b) {
  const double c = std::cos(a.phi), s = std::sin(a.phi), dx = b.x - a.x, dy = b.y - a.y;
  const double x = c * dx + s * dy, y = -s * dx + c * dy;
  RelationError out;
  out.e << x - T_a_b.x, y - T_a_b.y, mrpt::math::wrapToPi(b.phi - a.phi - T_a_b.phi);
  out.to_b << c, s, 0, -s, c, 0, 0, 0, 1;
  out.to_a = -out.to_b;
  out.to_a(0, 2) = y;
  out.to_a(1, 2) = -x;
  return out;
}

Eigen::Matrix3d variances(double sigma_xy, double sigma_phi) {
  return Eigen::Vector3d(sigma_xy * sigma_xy, sigma_xy * sigma_xy, sigma_phi * sigma_phi).asDiagonal();
}

Eigen::Matrix3d squareRootInformation(const Eigen::Matrix3d& covariance) {
  return covariance.inverse().llt().matrixU();
}

}  // namespace submap_slam
