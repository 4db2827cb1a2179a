#pragma once

#include <mrpt/math/TPoint2D.h>
#include <submap_slam/core/grid_submap.h>
#include <submap_slam/mapping/laser_points.h>
#include <submap_slam/mapping/surfel_map.h>

#include <vector>

namespace submap_slam {

struct SurfaceParams {
  int min_hits = 2;             ///< endpoints that a surfel needs to count as a surface
  double spacing = 0.1;         ///< m, side of the squares of which one point is kept for matching
  double sparse_spacing = 0.4;  ///< m, the same for the search of a window
};

/** The matching map of a finished submap: all its key scans where they belong. Frame: local map frame. */
SurfelMap surfelMapOf(const GridSubmap& submap, const SurfelMapParams& params = {});

/** Points on the surfaces of a submap, in its local map frame (m). */
struct SubmapSurface {
  LaserPoints dense;                         ///< for matching to a surfel map
  std::vector<mrpt::math::TPoint2D> sparse;  ///< for the search of a window
};

SubmapSurface surfaceOf(const SurfelMap& map, const SurfaceParams& params = {});

}  // namespace submap_slam
