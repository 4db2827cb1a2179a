#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/mapping/laser_points.h>
#include <submap_slam/mapping/probability_grid.h>
#include <submap_slam/mapping/surfel_map.h>

#include <vector>

namespace submap_slam {

/** Poses that a search looks at, and how closely. */
struct SearchWindow {
  double window_xy = 0.2;   ///< m, half width
  double window_phi = 0.4;  ///< rad, half width
  double step_xy = 0.1;     ///< m
  double step_phi = 0.04;   ///< rad
  int max_beams = 60;
};

struct CorrelativeSearchParams : SearchWindow {
  double sigma = 0.1;        ///< m
  double peak_ratio = 0.85;  ///< peaks scoring less than this share of the best are dropped
  int max_peaks = 8;
};

/** A local maximum of the match score around a pose. */
struct CorrelativePeak {
  mrpt::math::TPose2D pose;  ///< T_s_robot
  double score = 0;          ///< mean over beams, in [0, 1]
};

/** Exhaustive search of the window around `centre`; peaks in descending order of score, at least one. A beam
 * scores 1 / (1 + r²), r its distance from the nearest line in sigmas. */
std::vector<CorrelativePeak> correlativeSearch(const SurfelMap& map, const LaserPoints& scan,
                                               const mrpt::math::TPose2D& centre,
                                               const CorrelativeSearchParams& params);

/** The best pose of the window around `centre`. A beam scores the probability of the cell in which it ends.
 */
CorrelativePeak correlativeSearch(const ProbabilityGrid& grid, const LaserPoints& scan,
                                  const mrpt::math::TPose2D& centre, const SearchWindow& window);

}  // namespace submap_slam
