#pragma once

#include <mrpt/math/TPose2D.h>
#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace submap_slam::pose_graph {

/** A relation of two submap frames. */
struct Link {
  std::size_t from = 0, to = 0;
  mrpt::math::TPose2D T_a_b;                                 ///< frame `to` seen from frame `from`
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< how far it may be off: m², m·rad, rad²

  /** Of its usual error, which is far smaller. The search has to reckon with the former; when all is found a
   * robust estimate does better with the latter. */
  Eigen::Matrix3d usual_covariance = Eigen::Matrix3d::Identity();
  bool loop = false;     ///< from loop closure: may be wrong, so it gets a robust loss
  bool by_hand = false;  ///< from the user: certain, no robust loss anywhere
};

/** The submap frames and what is known between them. The first frame is fixed. */
struct FrameGraph {
  std::vector<mrpt::math::TPose2D> frames;  ///< T_w_s
  std::vector<Link> links;

  /** Moves the frames to the minimum of Σ ρ(eᵀ Ω e), ρ(s) = log(1 + s) for loops (Huang et al. 2024, eq. 12),
   * ρ(s) = s for the chain. Levenberg-Marquardt, sparse Cholesky (Ceres). */
  void optimise();
};

}  // namespace submap_slam::pose_graph
