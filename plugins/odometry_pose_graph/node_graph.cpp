#include "node_graph.h"

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <mrpt/math/wrap2pi.h>
#include <Eigen/LU>

#include <memory>

#include <submap_slam/core/relative_pose.h>
#include "residuals.h"
#include "solver.h"

namespace submap_slam::pose_graph {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using mrpt::math::TPose2D;

/** One problem from the first block to the last residual. */
class NodeProblem {
 public:
  NodeProblem(const GridSubmaps& submaps, const FrameGraph& graph, const FusionParams& params,
              const GraphNodes& nodes, const OdometryModel& odometry)
      : submaps_(submaps), params_(params), graph_nodes_(nodes), odometry_(odometry), problem_(ownership()) {
    placeBlocks(graph);
    for (const Link& link : graph.links)
      add(link.T_a_b, link.usual_covariance, blocks_[link.from].front(), blocks_[link.to].front(),
          link.by_hand ? nullptr : &cauchy_);
    if (!moveNodes()) return;
    addIntra();
    if (params.odometry == OdometryResidual::kSubmap)
      addOdometryFromFrames();
    else
      addOdometryAlongThePath();
  }

  Solution solve() { return submap_slam::pose_graph::solve(problem_); }

  TPose2D frame(std::size_t k) const { return blocks_[k].front().pose(); }

  /** T_s_node: matched poses, moved by what the graph nodes around them were moved. */
  std::vector<TPose2D> nodesOf(std::size_t k) const;

  bool moveNodes() const { return params_.odometry != OdometryResidual::kOff && odometry_.known(); }

 private:
  static ceres::Problem::Options ownership() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  const SubmapNode& node(std::size_t k, std::size_t g) const {
    return submaps_[k]->nodes[graph_nodes_[k][g]];
  }

  void placeBlocks(const FrameGraph& graph);
  void addIntra();
  void addOdometryFromFrames();
  void addOdometryAlongThePath();
  void addOdometry(const TPose2D& motion, double length, PoseBlock& a, PoseBlock& b);

  void add(const TPose2D& T_a_b, const Matrix3d& covariance, PoseBlock& a, PoseBlock& b) {
    add(T_a_b, covariance, a, b, &cauchy_);
  }

  /** @param loss may be null: none */
  void add(const TPose2D& T_a_b, const Matrix3d& covariance, PoseBlock& a, PoseBlock& b,
           ceres::LossFunction* loss) {
    problem_.AddResidualBlock(RelationResidual::cost(T_a_b, squareRootInformation(covariance)), loss,
                              a.values, b.values);
  }

  const GridSubmaps& submaps_;
  const FusionParams& params_;
  const GraphNodes& graph_nodes_;
  const OdometryModel& odometry_;
  ceres::CauchyLoss cauchy_{1};
  ceres::Problem problem_;
  std::vector<std::vector<PoseBlock>>
      blocks_;  ///< of the graph nodes; the first one of a submap is its frame
};

void NodeProblem::placeBlocks(const FrameGraph& graph) {
  for (std::size_t k = 0; k < submaps_.size(); ++k) {
    std::vector<PoseBlock> blocks{PoseBlock(graph.frames[k])};
    for (std::size_t g = 1; moveNodes() && g < graph_nodes_[k].size(); ++g)
      blocks.emplace_back(graph.frames[k] + node(k, g).pose);
    blocks_.push_back(std::move(blocks));
  }
  problem_.AddParameterBlock(blocks_.front().front().values, 3);
  problem_.SetParameterBlockConstant(blocks_.front().front().values);
}

void NodeProblem::addIntra() {
  const Matrix3d covariance = variances(params_.intra_sigma_xy, params_.intra_sigma_phi);
  for (std::size_t k = 0; k < submaps_.size(); ++k)
    for (std::size_t g = 1; g < blocks_[k].size(); ++g)
      add(node(k, g).pose, covariance, blocks_[k].front(), blocks_[k][g]);
}

void NodeProblem::addOdometry(const TPose2D& motion, double length, PoseBlock& a, PoseBlock& b) {
  constexpr double kStandstill_m = 0.01;  // no motion is known exactly
  Matrix3d covariance = odometry_.covariance(std::max(length, kStandstill_m));
  covariance.topLeftCorner<2, 2>() /= params_.odometry_weight_xy;
  covariance(2, 2) /= params_.odometry_weight_phi;
  add(motion, covariance, a, b);
}

void NodeProblem::addOdometryFromFrames() {
  for (std::size_t k = 0; k < submaps_.size(); ++k) {
    TPose2D loro;
    double length = 0;
    for (std::size_t g = 1; g < blocks_[k].size(); ++g) {
      const auto step = odometryBetween(node(k, g - 1), node(k, g));
      if (!step) break;
      const TPose2D motion = odometry_.corrected(*step);
      loro = loro + motion;
      length += odometryLength(motion);
      addOdometry(loro, length, blocks_[k].front(), blocks_[k][g]);
    }
  }
}

void NodeProblem::addOdometryAlongThePath() {
  for (std::size_t k = 0; k < submaps_.size(); ++k) {
    const auto link = [&](const SubmapNode& from, const SubmapNode& to, PoseBlock& a, PoseBlock& b) {
      const auto step = odometryBetween(from, to);
      if (!step) return;
      const TPose2D motion = odometry_.corrected(*step);
      addOdometry(motion, odometryLength(motion), a, b);
    };
    for (std::size_t g = 1; g < blocks_[k].size(); ++g)
      link(node(k, g - 1), node(k, g), blocks_[k][g - 1], blocks_[k][g]);
    const bool goes_on = submaps_[k]->has_successor && k + 1 < submaps_.size();
    if (!goes_on || graph_nodes_[k].empty() || graph_nodes_[k + 1].empty()) continue;
    link(node(k, blocks_[k].size() - 1), node(k + 1, 0), blocks_[k].back(), blocks_[k + 1].front());
  }
}

std::vector<TPose2D> NodeProblem::nodesOf(std::size_t k) const {
  const auto& matched = submaps_[k]->nodes;
  const auto& graph = graph_nodes_[k];
  const auto moved = [&](std::size_t g) {
    const TPose2D by = (blocks_[k][g].pose() - frame(k)) - node(k, g).pose;
    return Vector3d(by.x, by.y, mrpt::math::wrapToPi(by.phi));
  };
  std::vector<TPose2D> poses;
  poses.reserve(matched.size());
  for (std::size_t g = 0; g < graph.size(); ++g) {
    const bool last = g + 1 == graph.size();
    const Vector3d here = moved(g), next = last ? here : moved(g + 1);
    const std::size_t end = last ? matched.size() : graph[g + 1];
    for (std::size_t n = graph[g]; n < end; ++n) {
      const Vector3d by =
          here + (next - here) * static_cast<double>(n - graph[g]) / static_cast<double>(end - graph[g]);
      poses.push_back(matched[n].pose + TPose2D(by.x(), by.y(), by.z()));
    }
  }
  return poses;
}

/** The usual covariances, divided by what the loss makes of their weight at the result: ρ' = 1 / (1 + eᵀ Ω
 * e). */
void weightByTheResult(FrameGraph& graph) {
  for (Link& link : graph.links) {
    const Vector3d e = relationError(graph.frames[link.from], graph.frames[link.to], link.T_a_b).e;
    link.covariance = link.usual_covariance;
    if (!link.loop && !link.by_hand) link.covariance *= 1 + e.dot(link.usual_covariance.inverse() * e);
  }
}

}  // namespace

FusedGraph fuseOdometry(const GridSubmaps& submaps, FrameGraph found, const FusionParams& params) {
  const GraphNodes nodes = graphNodesOf(submaps, params.node_distance, params.node_angle);
  return fuseOdometry(submaps, std::move(found), params, odometryModelOf(submaps, nodes));
}

FusedGraph fuseOdometry(const GridSubmaps& submaps, FrameGraph found, const FusionParams& params,
                        const OdometryModel& odometry) {
  FusedGraph fused;
  fused.odometry = odometry;
  const GraphNodes nodes = graphNodesOf(submaps, params.node_distance, params.node_angle);
  NodeProblem problem(submaps, found, params, nodes, odometry);
  fused.solution = problem.solve();
  if (fused.solution != Solution::kUnusable) {
    for (std::size_t k = 0; k < submaps.size(); ++k) {
      found.frames[k] = problem.frame(k);
      found.frames[k].phi = mrpt::math::wrapToPi(found.frames[k].phi);
      if (problem.moveNodes()) fused.nodes.push_back(problem.nodesOf(k));
    }
  }
  weightByTheResult(found);
  fused.frames = std::move(found);
  return fused;
}

}  // namespace submap_slam::pose_graph
