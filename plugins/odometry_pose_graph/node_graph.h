#pragma once

#include <functional>
#include <string>
#include <vector>

#include "frame_graph.h"
#include "odometry_model.h"
#include "solver.h"

namespace submap_slam::pose_graph {

/** Which odometry residuals the graph has. */
enum class OdometryResidual {
  kOff,
  kSubmap,      ///< between submap frame and node (Huang et al. 2024, algorithm 1)
  kConsecutive  ///< between consecutive nodes, also across the end of a submap: errors of odometry add up
};

struct FusionParams {
  OdometryResidual odometry = OdometryResidual::kConsecutive;
  double odometry_weight_xy = 1, odometry_weight_phi = 1;  ///< factors on the information the log suggests
  double node_distance = 0.2;                              ///< m between nodes with a pose of their own
  double node_angle = 0.15;                                ///< rad
  double bend_up_to = 4;  ///< variance of odometry over that of matches up to which submaps bend; 0: never
  MatchNoise intra;       ///< of a node in its submap
};

/** Nodes and submap frames, and all that is known of them. */
struct FusedGraph {
  Solution solution = Solution::kConverged;  ///< if unusable, the frames are those to start from
  FrameGraph frames;
  OdometryModel odometry;
  bool bent = false;  ///< submaps were not rigid

  /** T_s_node of every node of every submap; empty without odometry residuals: nothing moves them then. */
  std::vector<std::vector<mrpt::math::TPose2D>> nodes;
};

/** Called with the frames that an iteration led to. */
using FramesCallback = std::function<void(const std::vector<mrpt::math::TPose2D>&)>;

/** Minimises over submap frames and nodes
 *
 *     Σ ρ(intra-submap) + Σ ρ(inter-submap) + Σ ρ(odometry)
 *
 * with residuals Lᵀ e (see RelationError) and ρ(s) = log(1 + s) (Huang et al. 2024, eq. 12). Intra-submap: a
 * node where it was matched in its submap, and the end pose, which is the next submap's frame. Inter-submap:
 * the loops of the graph. Where odometry is good (bend_up_to), a submap with a successor is a chain of
 * sections that drift away from each other (see SubmapDrift) instead of one rigid frame. What is by hand has
 * ρ(s) = s. Nodes between those with a pose of their own move along.
 * @param found frames to start from, chain and loops; their usual covariances count. Those of the chain come
 * back as far as the result bears them out: divided by ρ' there, unless the submap was bent.
 * @param show may be empty */
FusedGraph fuseOdometry(const GridSubmaps& submaps, FrameGraph found, const FusionParams& params,
                        const OdometryModel& odometry, const FramesCallback& show = {});

/** The same with the odometry model of the log. */
FusedGraph fuseOdometry(const GridSubmaps& submaps, FrameGraph found, const FusionParams& params,
                        const FramesCallback& show = {});

}  // namespace submap_slam::pose_graph
