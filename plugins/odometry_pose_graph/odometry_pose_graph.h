#pragma once

#include <submap_slam/core/submap_joiner.h>

#include "loop_search.h"

namespace submap_slam {

/** Closes loops: searches for submaps that show the same place, and makes the graph of submap frames
 * consistent with what it finds (residuals and loss of Huang et al., "A Construction Optimization for Laser
 * SLAM Based on Odometer Constraint Fusion", ITC 53(2), 2024). Odometry tells how far the chain may be off.
 */
class OdometryPoseGraph : public SubmapJoiner {
  DEFINE_MRPT_OBJECT(OdometryPoseGraph, submap_slam)

 public:
  std::string name() const override { return "odometry_pose_graph"; }
  std::string description() const override {
    return "loop closure and robust pose graph of the submap frames";
  }
  void describe(ParameterTable& table) override;

  JoinedMap join(const GridSubmaps& submaps, const JoinedMap& initial,
                 const ProgressCallback& progress) const override;

 private:
  pose_graph::LoopSearchParams search_;
};

}  // namespace submap_slam
