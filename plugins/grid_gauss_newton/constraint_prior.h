#pragma once

#include <Eigen/Core>
#include <vector>

#include "pose_system.h"
#include "pyramid.h"

namespace submap_slam::grid_joining {

/** What is known of the frames beside the evidence: the accepted constraints, that is the chain of end poses
 * and the loop closures of the joiner before.
 *
 * Evidence says nothing along a corridor; there this prior alone holds the frames. The residual of a
 * constraint is e = [R_a (t_b − t_a) − t̂ ; wrap(θ_b − θ_a − θ̂)], weighted with its inverse covariance.
 */
class ConstraintPrior {
 public:
  /** @param submaps say which frame a constraint means by a submap's id; constraints of others do not count
   * @param weight  multiplies the information of every constraint; 0 switches the prior off */
  ConstraintPrior(const std::vector<Constraint>& constraints, const GridSubmaps& submaps, double weight);

  /** Σ eᵀ Ω e */
  double cost(const Frames& frames) const;

  /** Σ JᵀΩJ and Σ JᵀΩe */
  PoseSystem linearise(const Frames& frames) const;

 private:
  struct Link {
    std::size_t from, to;  ///< frames
    mrpt::math::TPose2D T_a_b;
    Eigen::Matrix3d information;
  };

  std::vector<Link> links_;
};

}  // namespace submap_slam::grid_joining
