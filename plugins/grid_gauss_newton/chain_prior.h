#pragma once

#include <Eigen/Core>
#include <vector>

#include "pose_system.h"
#include "pyramid.h"

namespace submap_slam::grid_joining {

/** What the mapper knows about consecutive submaps: submap k+1 starts at the end pose of submap k, with its
 * covariance.
 *
 * Evidence says nothing along a corridor; there this prior alone holds the frames. Its residual is
 *    e = [R_k (t_{k+1} − t_k) − t̂ ; wrap(θ_{k+1} − θ_k − θ̂)],  weighted with the inverse covariance of the
 * end pose.
 */
class ChainPrior {
 public:
  /** @param weight multiplies the information of every link; 0 switches the prior off */
  ChainPrior(const GridSubmaps& submaps, double weight);

  /** Σ eᵀ Ω e */
  double cost(const Frames& frames) const;

  /** Σ JᵀΩJ and Σ JᵀΩe */
  PoseSystem linearise(const Frames& frames) const;

 private:
  struct Link {
    std::size_t from;  ///< to from + 1
    mrpt::math::TPose2D T_a_b;
    Eigen::Matrix3d information;
  };
  static Eigen::Vector3d residual(const Link& link, const Frames& frames);

  std::vector<Link> links_;
};

}  // namespace submap_slam::grid_joining
