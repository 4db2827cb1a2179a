#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/packed_evidence.h>
#include <submap_slam/mapping/laser_points.h>

namespace submap_slam {

struct AgreementParams {
  double tolerance = 0.15;  ///< m, a surface this near to an occupied cell is a hit
  double free_hits = 2;     ///< observations that a cell needs to count as free
};

/** How surfaces of one submap fare in the map of another. */
struct MapAgreement {
  double hit_share = 0;  ///< share of all points that fall on occupied cells

  /** hits / (hits + points in free space): what they say where both have seen something; 1 if nowhere. */
  double agreement = 1;
};

/** @param T_map_points pose of the points' frame in the map's local map frame */
MapAgreement agreementOf(const LaserPoints& points, const PackedEvidence& map,
                         const mrpt::math::TPose2D& T_map_points, const AgreementParams& params = {});

}  // namespace submap_slam
