#include <submap_slam/core/joined_map.h>

#include <stdexcept>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::poses::CPosePDFGaussian;

void requireOneFrameEach(const GridSubmaps& submaps, const std::vector<CPosePDFGaussian>& frames) {
  if (submaps.size() != frames.size()) throw std::invalid_argument("one frame is needed for each submap");
}

}  // namespace

const char* toString(JoinStatus status) {
  switch (status) {
    case JoinStatus::kChained:
      return "chained";
    case JoinStatus::kConverged:
      return "converged";
    case JoinStatus::kIterationLimit:
      return "iteration limit";
    case JoinStatus::kNothingToJoin:
      return "nothing to join";
    case JoinStatus::kFailed:
      return "failed";
  }
  return "unknown";
}

JoinedMap chainSubmaps(const GridSubmaps& submaps) {
  JoinedMap chain;
  CPosePDFGaussian frame;  // identity, no uncertainty
  frame.cov.setZero();
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    chain.frames.push_back(frame);
    const GridSubmap& submap = *submaps[k];
    if (submap.has_successor && k + 1 < submaps.size()) {
      Constraint link;
      link.from = submap.id;
      link.to = submaps[k + 1]->id;
      link.T_a_b = submap.end_pose;
      link.reason = "end pose of the submap";
      chain.constraints.push_back(link);
    }
    frame += submap.end_pose;
  }
  return chain;
}

std::vector<TPose2D> nodePosesOf(const GridSubmaps& submaps, const JoinedMap& joined, std::size_t k) {
  const auto& nodes = submaps.at(k)->nodes;
  if (!joined.nodes.empty()) {
    if (joined.nodes.size() != submaps.size() || joined.nodes[k].size() != nodes.size())
      throw std::invalid_argument("one pose for each node of each submap is needed");
    return joined.nodes[k];
  }
  std::vector<TPose2D> poses;
  poses.reserve(nodes.size());
  for (const SubmapNode& node : nodes) poses.push_back(node.pose);
  return poses;
}

Trajectory trajectoryOf(const GridSubmaps& submaps, const JoinedMap& joined) {
  requireOneFrameEach(submaps, joined.frames);
  Trajectory trajectory;
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    const TPose2D T_w_s = joined.frames[k].mean.asTPose();
    const std::vector<TPose2D> poses = nodePosesOf(submaps, joined, k);
    for (std::size_t n = 0; n < poses.size(); ++n)
      trajectory.push_back({submaps[k]->nodes[n].stamp, T_w_s + poses[n]});
  }
  return trajectory;
}

Trajectory odometryOf(const std::vector<Frame>& frames) {
  Trajectory trajectory;
  for (const Frame& frame : frames)
    if (frame.odometry) trajectory.push_back({frame.stamp, *frame.odometry});
  return trajectory;
}

}  // namespace submap_slam
