#include "frame_graph.h"

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <mrpt/math/wrap2pi.h>

#include <submap_slam/core/relative_pose.h>
#include "residuals.h"
#include "solver.h"

namespace submap_slam::pose_graph {

void FrameGraph::optimise() {
  std::vector<PoseBlock> blocks(frames.begin(), frames.end());
  ceres::CauchyLoss cauchy(1);
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (auto& block : blocks) problem.AddParameterBlock(block.values, 3);
  for (const Link& link : links)
    problem.AddResidualBlock(RelationResidual::cost(link.T_a_b, squareRootInformation(link.covariance)),
                             link.loop ? &cauchy : nullptr, blocks[link.from].values, blocks[link.to].values);
  problem.SetParameterBlockConstant(blocks.front().values);

  if (solve(problem) == Solution::kUnusable) return;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i] = blocks[i].pose();
    frames[i].phi = mrpt::math::wrapToPi(frames[i].phi);
  }
}

}  // namespace submap_slam::pose_graph
