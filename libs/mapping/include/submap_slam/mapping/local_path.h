#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/mapping/match_result.h>
#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace submap_slam {

/** What a hypothesis says of one frame. */
struct PathNode {
  mrpt::math::TPose2D pose;                               ///< T_s_robot
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the scan in the map, (x, y, φ)
  float inlier_share = 1;
  bool key = false;         ///< inserted into the map
  bool by_odometry = true;  ///< agrees with odometry since the last such node

  void take(const MatchResult& match) {
    pose = match.pose;
    information = match.information;
    inlier_share = static_cast<float>(match.inlier_share);
  }
};

/** One node for each frame so far, in log order. */
using LocalPath = std::vector<PathNode>;

/** Standard deviations of odometry over one step; wide on purpose: the matcher decides. */
struct MotionParams {
  double sigma_xy = 0.01;           ///< m
  double sigma_xy_per_m = 0.10;     ///< m per m
  double sigma_phi = 0.02;          ///< rad
  double sigma_phi_per_rad = 0.10;  ///< rad per rad
  double sigma_phi_per_m = 0.05;    ///< rad per m
};

/** Information of the odometry prior over one step. */
Eigen::Matrix3d motionInformation(const MotionParams& params, const mrpt::math::TPose2D& increment);

/** The last motion again; nothing if there is none yet. */
mrpt::math::TPose2D lastIncrement(const LocalPath& path);

/** Mean share of inlier beams over the last scans before node `end` of a path, at least one: how well scans
 * can be expected to fit there. In the open, where most beams end where nothing was seen before, it is low
 * without anything being wrong. */
double usualInlierShare(const LocalPath& path, std::size_t end);

/** After how much motion a scan is inserted into the map. */
struct KeyParams {
  double distance = 0.15;  ///< m
  double angle = 0.1;      ///< rad
};

/** True if a scan taken at `pose`, after those of `path`, is to be inserted into the map. */
bool isKeyPose(const LocalPath& path, const mrpt::math::TPose2D& pose, const KeyParams& keys);

}  // namespace submap_slam
