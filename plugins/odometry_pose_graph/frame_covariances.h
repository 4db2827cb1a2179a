#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <map>
#include <utility>

#include "frame_graph.h"

namespace submap_slam::pose_graph {

/** What the graph, linearised at its frames, knows about them; the first frame is exact. Columns of the
 * covariance are solved for when they are asked for, never the whole dense matrix. */
class FrameCovariances {
 public:
  explicit FrameCovariances(const FrameGraph& graph);

  /** Covariance of frames i and k, in the global map frame. */
  Eigen::Matrix3d block(std::size_t i, std::size_t k) const;

  using Pair = std::pair<std::size_t, std::size_t>;

  /** Covariance of T_a_b, in the axes of a. */
  Eigen::Matrix3d relative(const Pair& ab) const { return crossed(ab, ab); }

  /** Cross-covariance of two relative poses. */
  Eigen::Matrix3d crossed(const Pair& ab, const Pair& cd) const;

 private:
  const Eigen::MatrixXd& column(std::size_t frame) const;

  std::vector<mrpt::math::TPose2D> frames_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  mutable std::map<std::size_t, Eigen::MatrixXd> columns_;
};

}  // namespace submap_slam::pose_graph
