#pragma once

#include <mrpt/math/TPose2D.h>
#include <Eigen/Core>

namespace submap_slam {

/** How far poses in a submap can be trusted. */
struct DriftParams {
  double match_scale = 0.06;
  double odometry_scale = 0.6;
  double sigma_xy_per_m = 0.001;    ///< m per √m
  double sigma_phi_per_m = 0.0001;  ///< rad per √m
};

/** Covariance of the robot's pose relative to the submap's frame, accumulated along the path from the
 * information of the matches (the spread of a particle filter is overconfident by far):
 *
 *     P ← J P Jᵀ + (H / match_scale² + Λ / odometry_scale²)⁻¹ at each key scan,
 *
 * J the lever arm of the motion since, H the scan's information in the map, Λ that of odometry; plus a floor
 * that grows with the distance. The scale of the matches is far below 1: the matcher's sigma is the width of
 * its robust loss, several times the noise of a beam, and successive scans are matched to the same map, so
 * their errors add up much slower than independent ones.
 */
class DriftCovariance {
 public:
  explicit DriftCovariance(const DriftParams& params) : params_(params) {}

  /** The robot moved from one pose to another, both in the submap's frame. */
  void move(const mrpt::math::TPose2D& from, const mrpt::math::TPose2D& to);

  /** A key scan was inserted here.
   * @param scan      H, information of its match
   * @param odometry  Λ, that of the motion prior; wide on purpose, so its scale is below 1 too */
  void addKeyScan(const Eigen::Matrix3d& scan, const Eigen::Matrix3d& odometry);

  /** Of (x, y, φ) at the last pose; m², m·rad, rad². */
  Eigen::Matrix3d covariance() const;

  /** Largest standard deviation of the position (m). */
  double sigmaXy() const;

  /** Standard deviation of the heading (rad). */
  double sigmaPhi() const;

 private:
  DriftParams params_;
  Eigen::Matrix3d sum_ = Eigen::Matrix3d::Zero();
  double path_ = 0;  ///< m
};

}  // namespace submap_slam
