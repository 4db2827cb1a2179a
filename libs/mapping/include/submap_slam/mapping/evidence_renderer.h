#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/evidence_grid.h>
#include <submap_slam/mapping/laser_points.h>

#include <vector>

namespace submap_slam {

struct EvidenceParams {
  double resolution = 0.05;         ///< m
  double max_range = 20.0;          ///< m
  double occupied_log_odds = 0.85;  ///< log(0.7 / 0.3)
  double free_log_odds = -0.4;      ///< log(0.4 / 0.6)
};

/** A scan and where it was taken. */
struct PlacedScan {
  const LaserPoints* scan = nullptr;
  mrpt::math::TPose2D pose;  ///< T_s_robot
};

/** Renders scans into an evidence grid in the frame of their poses: each beam adds free evidence to the cells
 * it crosses and occupied evidence, spread bilinearly, around its endpoint. The sums are not saturated. The
 * grid is cropped to what was seen; beams longer than `max_range` leave free evidence up to it only. */
EvidenceGrid renderEvidence(const std::vector<PlacedScan>& scans, const EvidenceParams& params);

}  // namespace submap_slam
