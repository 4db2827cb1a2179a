#pragma once

#include <submap_slam/core/joined_map.h>
#include <Eigen/Core>

#include <optional>
#include <vector>

namespace submap_slam::pose_graph {

/** The nodes of each submap (indices into its `nodes`) that get a pose of their own in the graph: the first
 * one, and each that is far enough from the one before. */
using GraphNodes = std::vector<std::vector<std::size_t>>;

/** @param distance m  @param angle rad; either suffices */
GraphNodes graphNodesOf(const GridSubmaps& submaps, double distance, double angle);

/** Odometry's idea of a motion, T_a_b, from the poses at both ends (Huang et al. 2024, algorithm 1: `loro`);
 * empty if one is missing. */
std::optional<mrpt::math::TPose2D> odometryBetween(const SubmapNode& a, const SubmapNode& b);

/** How far to believe the odometry of a log, from what the scans say: the weights of its residuals, for
 * translation and rotation apart.
 *
 * Disagreement between odometry and scans that grows with the way is put down to odometry, drift of the
 * matches included, and so is what single steps have beyond the noise of matches. Where scans see nothing,
 * along a corridor, the matched poses follow odometry and agree with it whatever its error.
 */
struct OdometryModel {
  double gain_xy = 1, gain_phi = 1;          ///< true motion / odometry's motion
  double variance_xy = 0, variance_phi = 0;  ///< per length (m², rad²): see odometryLength; 0: no odometry
  std::size_t steps = 0;                     ///< from which that is known

  bool known() const { return variance_xy > 0 && variance_phi > 0; }
  mrpt::math::TPose2D corrected(const mrpt::math::TPose2D& odometry) const;
  Eigen::Matrix3d covariance(double length) const;
};

/** What the variance of odometry grows with: metres moved, and 0.3 m for each radian turned. */
double odometryLength(const mrpt::math::TPose2D& motion);

/** Errors of the pose of a node in its submap, of each by itself. */
struct MatchNoise {
  double sigma_xy = 0.005;   ///< m
  double sigma_phi = 0.001;  ///< rad
};

/** Medians and quantiles over all steps between graph nodes of a submap, so that slips, which are few, don't
 * count. */
OdometryModel odometryModelOf(const GridSubmaps& submaps, const GraphNodes& nodes, const MatchNoise& match);

}  // namespace submap_slam::pose_graph
