#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/mapping/correlative_search.h>
#include <submap_slam/mapping/laser_points.h>
#include <submap_slam/mapping/match_result.h>
#include <submap_slam/mapping/probability_grid.h>
#include <Eigen/Core>

namespace submap_slam {

/** Section [scan_matching]. */
struct ScanMatchingParams {
  ProbabilityGridParams grid;
  double translation_weight = 3.0;  ///< 1/m
  double rotation_weight = 1.0;     ///< 1/rad
  int max_iterations = 30;
  double information_share = 0.003;
  bool correlative_search = false;
  SearchWindow window{0.2, 0.35, 0.1, 0.02, 60};
};

/** Pose of a scan in a probability grid, the front end of Huang et al. 2024:
 *
 *     min 1/(2n) Σ_b (1 − M(T h_b))² + ½ w_t² ‖t − t̂‖² + ½ w_r² (φ − φ̂)²,
 *
 * M the grid's probability, interpolated bicubically (eq. 4), h_b the n endpoints of the scan, (t̂, φ̂) the
 * pose that odometry predicts. Solved by Ceres from the prediction, after a search also from the best pose of
 * the window around it (Olson, ICRA 2009); the lower cost counts.
 */
class GridScanMatcher {
 public:
  explicit GridScanMatcher(const ScanMatchingParams& params) : params_(params) {}

  /** `inlier_share` counts beams that end where M > ½. `information` is the Gauss-Newton Hessian of the scan
   * term over the mean square of 1 − M, times `information_share`. Where Ceres fails: the prediction.
   * @param scan    not empty
   * @param search  look for another start in the window */
  MatchResult match(const ProbabilityGrid& grid, const LaserPoints& scan,
                    const mrpt::math::TPose2D& prediction, bool search) const;

  /** The scan term at a pose. */
  struct Evaluation {
    double cost = 0;  ///< 1/(2n) Σ (1 − M)²
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();  ///< Gauss-Newton's
    std::size_t inliers = 0;
  };
  static Evaluation evaluate(const ProbabilityGrid& grid, const LaserPoints& scan,
                             const mrpt::math::TPose2D& pose);

 private:
  ScanMatchingParams params_;
};

}  // namespace submap_slam
