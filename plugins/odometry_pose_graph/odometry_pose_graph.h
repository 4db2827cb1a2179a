#pragma once

#include <submap_slam/core/submap_joiner.h>

#include "loop_search.h"
#include "node_graph.h"

namespace submap_slam {

/** Closes loops and fuses odometry.
 *
 * Searches for submaps that show the same place, however far the chain has drifted; then makes nodes and
 * submap frames, with the odometry between them, consistent (Huang et al., "A Construction Optimization for
 * Laser SLAM Based on Odometer Constraint Fusion", ITC 53(2), 2024).
 */
class OdometryPoseGraph : public SubmapJoiner {
  DEFINE_MRPT_OBJECT(OdometryPoseGraph, submap_slam)

 public:
  std::string name() const override { return "odometry_pose_graph"; }
  std::string description() const override {
    return "loop closure and pose graph with fused odometry (Huang et al. 2024)";
  }
  void describe(ParameterTable& table) override;

  JoinedMap join(const GridSubmaps& submaps, const JoinedMap& initial,
                 const ProgressCallback& progress) const override;

  /** Searches each submap once; nodes and frames are fused anew each time. */
  std::unique_ptr<IncrementalJoin> incremental() const override;

 private:
  pose_graph::LoopSearchParams search_;
  pose_graph::FusionParams fusion_;
  std::string odometry_ = "consecutive";
};

}  // namespace submap_slam
