#include "frame_covariances.h"

#include <Eigen/LU>

#include <submap_slam/core/relative_pose.h>

namespace submap_slam::pose_graph {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;

Index rowOf(std::size_t frame) { return 3 * (static_cast<Index>(frame) - 1); }

}  // namespace

FrameCovariances::FrameCovariances(const FrameGraph& graph) : frames_(graph.frames) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](std::size_t i, std::size_t k, const Matrix3d& block) {
    if (i == 0 || k == 0) return;
    for (Index r = 0; r < 3; ++r)
      for (Index c = 0; c < 3; ++c) entries.emplace_back(rowOf(i) + r, rowOf(k) + c, block(r, c));
  };
  for (const Link& link : graph.links) {
    const RelationError at = relationError(frames_[link.from], frames_[link.to], link.T_a_b);
    Matrix3d information = link.covariance.inverse();
    if (link.loop) information /= 1 + at.e.dot(information * at.e);  // ρ' of the robust loss
    add(link.from, link.from, at.to_a.transpose() * information * at.to_a);
    add(link.from, link.to, at.to_a.transpose() * information * at.to_b);
    add(link.to, link.from, at.to_b.transpose() * information * at.to_a);
    add(link.to, link.to, at.to_b.transpose() * information * at.to_b);
  }
  const Index size = 3 * (static_cast<Index>(frames_.size()) - 1);
  if (size == 0) return;
  Eigen::SparseMatrix<double> information(size, size);
  information.setFromTriplets(entries.begin(), entries.end());
  factor_.compute(information);
}

const Eigen::MatrixXd& FrameCovariances::column(std::size_t frame) const {
  Eigen::MatrixXd& column = columns_[frame];
  if (column.size() == 0) {
    column = Eigen::MatrixXd::Zero(factor_.rows(), 3);
    column.middleRows<3>(rowOf(frame)).setIdentity();
    column = factor_.solve(column).eval();
  }
  return column;
}

Matrix3d FrameCovariances::block(std::size_t i, std::size_t k) const {
  if (i == 0 || k == 0) return Matrix3d::Zero();
  return column(k).middleRows<3>(rowOf(i));
}

Matrix3d FrameCovariances::crossed(const Pair& ab, const Pair& cd) const {
  const auto jacobians = [&](const Pair& p) {
    return relationError(frames_[p.first], frames_[p.second], frames_[p.second] - frames_[p.first]);
  };
  const RelationError left = jacobians(ab), right = jacobians(cd);
  return left.to_a * block(ab.first, cd.first) * right.to_a.transpose() +
         left.to_a * block(ab.first, cd.second) * right.to_b.transpose() +
         left.to_b * block(ab.second, cd.first) * right.to_a.transpose() +
         left.to_b * block(ab.second, cd.second) * right.to_b.transpose();
}

}  // namespace submap_slam::pose_graph
