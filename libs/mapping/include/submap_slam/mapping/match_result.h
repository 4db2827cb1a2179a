#pragma once

#include <mrpt/math/TPose2D.h>
#include <Eigen/Core>

namespace submap_slam {

/** Where a scan matcher says that a scan was taken. */
struct MatchResult {
  mrpt::math::TPose2D pose;                               ///< T_s_robot
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the scan term alone at `pose`, (x, y, φ)
  double cost = 0;                                        ///< the matcher's own: scan term + prior term
  double inlier_share = 0;                                ///< share of all beams that the map explains
  int iterations = 0;
};

}  // namespace submap_slam
