#include "node_graph.h"

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <mrpt/math/wrap2pi.h>
#include <Eigen/LU>

#include <algorithm>
#include <deque>
#include <memory>

#include <submap_slam/core/relative_pose.h>
#include "residuals.h"
#include "solver.h"
#include "submap_drift.h"

namespace submap_slam::pose_graph {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using mrpt::math::TPose2D;

/** Path after which a submap may have bent by something. */
constexpr double kSection_m = 1;
/** Two poses are never nearer, as far as drift goes. */
constexpr double kShortestPath_m = 0.01;
/** The end pose of a submap, as a relation of its frame and the next one. */
bool isEndOfSubmap(const GridSubmaps& submaps, const Link& link) {
  return !link.loop && !link.by_hand && link.to == link.from + 1 && submaps[link.from]->has_successor;
}

/** One problem from the first block to the last residual. */
class NodeProblem {
 public:
  NodeProblem(const GridSubmaps& submaps, const FrameGraph& graph, const FusionParams& params,
              const GraphNodes& nodes, const OdometryModel& odometry)
      : submaps_(submaps), params_(params), graph_nodes_(nodes), odometry_(odometry), problem_(ownership()) {
    placeBlocks(graph);
    const std::vector<Bend> bends = bendsOf(graph);
    bent_ = !bends.empty();
    for (const Link& link : graph.links)
      if (!bent_ || !isEndOfSubmap(submaps_, link))
        add(link.T_a_b, link.usual_covariance, blocks_[link.from].front(), blocks_[link.to].front(),
            link.by_hand ? nullptr : &cauchy_);
    if (!moveNodes()) return;
    for (const Bend& bend : bends) addBent(bend);
    for (std::size_t k = 0; k < submaps.size(); ++k)
      if (!bent_ || !submaps[k]->has_successor) addRigid(k);
    if (params.odometry == OdometryResidual::kSubmap)
      addOdometryFromFrames();
    else
      addOdometryAlongThePath();
  }

  Solution solve(const FramesCallback& show) {
    if (!show) return submap_slam::pose_graph::solve(problem_);
    return submap_slam::pose_graph::solve(problem_, [&] {
      std::vector<TPose2D> frames;
      for (std::size_t k = 0; k < blocks_.size(); ++k) frames.push_back(frame(k));
      show(frames);
    });
  }

  TPose2D frame(std::size_t k) const { return blocks_[k].front().pose(); }

  /** T_s_node: matched poses, moved by what the graph nodes around them were moved. */
  std::vector<TPose2D> nodesOf(std::size_t k) const;

  bool bent() const { return bent_; }

  bool moveNodes() const { return params_.odometry != OdometryResidual::kOff && odometry_.known(); }

 private:
  /** A submap that may bend along its path. */
  struct Bend {
    const Link* end;  ///< from its frame to that of the next one
    SubmapDrift drift;
  };

  static ceres::Problem::Options ownership() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  const SubmapNode& node(std::size_t k, std::size_t g) const {
    return submaps_[k]->nodes[graph_nodes_[k][g]];
  }

  /** How far node g is from the one before along the path, see odometryLength. */
  double lengthTo(std::size_t k, std::size_t g) const {
    return odometryLength(node(k, g).pose - node(k, g - 1).pose);
  }

  /** The same of the end pose and the last node. */
  double lengthToEnd(std::size_t k) const {
    const TPose2D T_s_end = submaps_[k]->end_pose.mean.asTPose();
    const std::size_t nodes = blocks_[k].size();
    return std::max(kShortestPath_m, odometryLength(nodes > 1 ? T_s_end - node(k, nodes - 1).pose : T_s_end));
  }

  void placeBlocks(const FrameGraph& graph);
  std::vector<Bend> bendsOf(const FrameGraph& graph) const;
  void addRigid(std::size_t k);
  void addBent(const Bend& bend);
  Matrix3d odometryCovariance(double length) const;
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
      blocks_;                     ///< of the graph nodes; the first one of a submap is its frame
  std::deque<PoseBlock> anchors_;  ///< of submaps that bend
  bool bent_ = false;
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

/** All submaps with a successor, or none if odometry is so much worse than the matches that it has nothing to
 * say of how a submap bends. Residuals from the frame to each node count odometry's first steps many times:
 * they never bend submaps. */
std::vector<NodeProblem::Bend> NodeProblem::bendsOf(const FrameGraph& graph) const {
  if (!moveNodes() || params_.odometry != OdometryResidual::kConsecutive) return {};
  std::vector<Bend> bends;
  std::vector<DriftRate> rates;
  for (const Link& link : graph.links) {
    if (!isEndOfSubmap(submaps_, link)) continue;
    double length = lengthToEnd(link.from);
    for (std::size_t g = 1; g < blocks_[link.from].size(); ++g) length += lengthTo(link.from, g);
    bends.push_back({&link, SubmapDrift(link.usual_covariance, length)});
    rates.push_back(bends.back().drift.rate());
  }
  const DriftRate usual = medianOf(rates);
  const Matrix3d odometry = odometryCovariance(1);
  const bool worth =
      odometry(0, 0) <= params_.bend_up_to * usual.xy || odometry(2, 2) <= params_.bend_up_to * usual.phi;
  if (!worth) return {};
  for (Bend& bend : bends) bend.drift.limit(usual);
  return bends;
}

void NodeProblem::addRigid(std::size_t k) {
  const Matrix3d by_match = variances(params_.intra.sigma_xy, params_.intra.sigma_phi);
  for (std::size_t g = 1; g < blocks_[k].size(); ++g)
    add(node(k, g).pose, by_match, blocks_[k].front(), blocks_[k][g]);
}

/** The path in sections, each with an anchor that has drifted away from the one before; the first one is the
 * frame of the submap. Nodes hang on the anchor of their section, the next submap's frame on the last one. */
void NodeProblem::addBent(const Bend& bend) {
  const std::size_t k = bend.end->from;
  const Matrix3d by_match = variances(params_.intra.sigma_xy, params_.intra.sigma_phi);
  PoseBlock* anchor = &blocks_[k].front();
  TPose2D T_s_anchor;
  double length = 0;
  for (std::size_t g = 1; g < blocks_[k].size(); ++g) {
    const TPose2D& T_s_node = node(k, g).pose;
    const TPose2D T_anchor_node = T_s_node - T_s_anchor;
    add(T_anchor_node, by_match, *anchor, blocks_[k][g]);
    length += lengthTo(k, g);
    if (length < kSection_m) continue;
    PoseBlock& next = anchors_.emplace_back(blocks_[k][g]);
    add(T_anchor_node, bend.drift.over(length, T_s_anchor), *anchor, next);
    anchor = &next;
    T_s_anchor = T_s_node;
    length = 0;
  }
  add(bend.end->T_a_b - T_s_anchor, bend.drift.overLast(length + lengthToEnd(k), T_s_anchor), *anchor,
      blocks_[bend.end->to].front());
}

Matrix3d NodeProblem::odometryCovariance(double length) const {
  Matrix3d covariance = odometry_.covariance(length);
  covariance.topLeftCorner<2, 2>() /= params_.odometry_weight_xy;
  covariance(2, 2) /= params_.odometry_weight_phi;
  return covariance;
}

void NodeProblem::addOdometry(const TPose2D& motion, double length, PoseBlock& a, PoseBlock& b) {
  constexpr double kStandstill_m = 0.01;  // no motion is known exactly
  add(motion, odometryCovariance(std::max(length, kStandstill_m)), a, b);
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
 * e). The end of a bent submap is off by what odometry knows better, which is no reason to doubt the result.
 */
void weightByTheResult(FrameGraph& graph, const GridSubmaps& submaps, bool bent) {
  for (Link& link : graph.links) {
    const Vector3d e = relationError(graph.frames[link.from], graph.frames[link.to], link.T_a_b).e;
    link.covariance = link.usual_covariance;
    const bool certain = link.loop || link.by_hand || (bent && isEndOfSubmap(submaps, link));
    if (!certain) link.covariance *= 1 + e.dot(link.usual_covariance.inverse() * e);
  }
}

}  // namespace

FusedGraph fuseOdometry(const GridSubmaps& submaps, FrameGraph found, const FusionParams& params,
                        const FramesCallback& show) {
  const GraphNodes nodes = graphNodesOf(submaps, params.node_distance, params.node_angle);
  return fuseOdometry(submaps, std::move(found), params, odometryModelOf(submaps, nodes, params.intra), show);
}

FusedGraph fuseOdometry(const GridSubmaps& submaps, FrameGraph found, const FusionParams& params,
                        const OdometryModel& odometry, const FramesCallback& show) {
  FusedGraph fused;
  fused.odometry = odometry;
  const GraphNodes nodes = graphNodesOf(submaps, params.node_distance, params.node_angle);
  NodeProblem problem(submaps, found, params, nodes, odometry);
  fused.solution = problem.solve(show);
  if (fused.solution != Solution::kUnusable) {
    for (std::size_t k = 0; k < submaps.size(); ++k) {
      found.frames[k] = problem.frame(k);
      found.frames[k].phi = mrpt::math::wrapToPi(found.frames[k].phi);
      if (problem.moveNodes()) fused.nodes.push_back(problem.nodesOf(k));
    }
  }
  fused.bent = problem.bent();
  weightByTheResult(found, submaps, fused.bent);
  fused.frames = std::move(found);
  return fused;
}

}  // namespace submap_slam::pose_graph
