#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/mapping/laser_points.h>
#include <submap_slam/mapping/match_result.h>
#include <submap_slam/mapping/surfel_map.h>
#include <Eigen/Core>

namespace submap_slam {

struct MatcherParams {
  double line_sigma = 0.05;   ///< m
  double cauchy_scale = 1.0;  ///< in units of line_sigma
  int max_iterations = 30;
};

/** Gaussian belief about a pose before the scan is seen. */
struct PosePrior {
  mrpt::math::TPose2D mean;                               ///< T_s_robot
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of (x, y, φ)
};

/** Maximum-a-posteriori pose of a scan in a surfel map: Levenberg-Marquardt on robust point-to-line distances
 *
 *     min ½ Σ_b c² log(1 + r_b² / c²) + ½ ‖pose − prior‖²_Λ,   r_b = n_bᵀ (T p_b − q_b) / σ,
 *
 * q_b, n_b the line of the surfel nearest to T p_b. Beams without a surfel pay the cost of one at the search
 * radius.
 */
class ScanMatcher {
 public:
  ScanMatcher(const MatcherParams& params, double search_radius);

  MatchResult match(const SurfelMap& map, const LaserPoints& scan, const PosePrior& prior,
                    const mrpt::math::TPose2D& start) const;

  MatchResult match(const SurfelMap& map, const LaserPoints& scan, const PosePrior& prior) const {
    return match(map, scan, prior, prior.mean);
  }

  /** Sum over beams of the robust cost at a pose, with gradient and Gauss-Newton Hessian (scan term only).
   * @param softness factor on line_sigma */
  struct Evaluation {
    double cost = 0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
    std::size_t inliers = 0;
  };
  Evaluation evaluate(const SurfelMap& map, const LaserPoints& scan, const mrpt::math::TPose2D& pose,
                      double softness = 1.0) const;

 private:
  /** @param at evaluation at `start` with the same softness */
  MatchResult minimise(const SurfelMap& map, const LaserPoints& scan, const PosePrior& prior,
                       const mrpt::math::TPose2D& start, Evaluation at, double softness) const;

  MatcherParams params_;
  double unmatched_cost_;
};

}  // namespace submap_slam
