#pragma once

#include <mrpt/math/TPose2D.h>
#include <Eigen/Core>

#include <vector>

namespace submap_slam::pose_graph {

/** Variances over each length of a path (see odometryLength): m², rad². */
struct DriftRate {
  double xy = 0, phi = 0;
};

/** How matched poses drift along a submap: a random walk that grows with the path and makes up the covariance
 * of the end pose. */
class SubmapDrift {
 public:
  /** @param end_covariance of T_s_end, in the axes of the submap (m², m·rad, rad²)  @param length > 0 */
  SubmapDrift(const Eigen::Matrix3d& end_covariance, double length);

  DriftRate rate() const { return {xy_.trace() / 2, phi_}; }

  /** No more drift than that along the path: an end pose that is less certain was made so by its last step,
   * and keeps the rest of its covariance there. */
  void limit(const DriftRate& usual);

  /** Covariance of a stretch of the path, in the axes of the pose T_s_a where it begins. */
  Eigen::Matrix3d over(double length, const mrpt::math::TPose2D& T_s_a) const;

  /** The same of a stretch up to the end pose. */
  Eigen::Matrix3d overLast(double length, const mrpt::math::TPose2D& T_s_a) const;

 private:
  Eigen::Matrix2d xy_;  ///< m² per length, in the axes of the submap
  double phi_;          ///< rad² per length
  Eigen::Matrix3d end_covariance_;
  Eigen::Matrix3d last_step_;  ///< what it has beyond the walk, in the axes of the submap
};

/** Of xy and phi, each by itself; zero if there is nothing. */
DriftRate medianOf(const std::vector<DriftRate>& rates);

}  // namespace submap_slam::pose_graph
