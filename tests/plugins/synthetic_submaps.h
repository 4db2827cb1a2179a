#pragma once

#include <submap_slam/core/joined_map.h>

#include <cstdint>
#include <vector>

namespace submap_slam::testing {

/** A wall of the synthetic world (m, global map frame). */
struct Wall {
  double x0, y0, x1, y1;
};
using World = std::vector<Wall>;

/** A 10 m × 8 m room around the origin with a few pieces of furniture, without any symmetry. */
World room();

/** Two parallel walls 2 m apart along x, with no other feature. */
World corridor(double length);

/** Evidence of the walls written down as a formula, not by any code under test: a profile across each wall,
 * more hits near the sensor, which stands at the frame's origin and sees `range` far.
 * @param noise standard deviation of the log-odds per hit, independent for each cell, from `seed` */
GridSubmap::Ptr renderSubmap(const World& world, const mrpt::math::TPose2D& T_w_s, double range,
                             double resolution, double noise = 0, uint32_t seed = 0);

/** The same, but cells behind walls are unknown. */
GridSubmap::Ptr scanSubmap(const World& world, const mrpt::math::TPose2D& T_w_s, double range,
                           double resolution, double noise = 0, uint32_t seed = 0);

/** Evidence of hills and valleys without end that never repeat, all of it seen: cheap, for many submaps. */
GridSubmap::Ptr landscapeSubmap(const mrpt::math::TPose2D& T_w_s, double range, double resolution);

/** Links each submap to the next by the true relative pose with the given standard deviations, and numbers
 * them. */
void linkChain(const GridSubmaps& submaps, const std::vector<mrpt::math::TPose2D>& true_frames,
               double sigma_m, double sigma_rad);

/** Smooth random evidence without structure, observed in an irregular part of the grid. */
GridSubmap::Ptr randomSubmap(uint32_t seed, double width, double height, double resolution);

/** Evidence of independent random cells, some of them unknown. */
GridSubmap::Ptr roughSubmap(uint32_t seed, double width, double height, double resolution);

/** Frames without covariance. */
std::vector<mrpt::poses::CPosePDFGaussian> asGaussians(const std::vector<mrpt::math::TPose2D>& frames);

}  // namespace submap_slam::testing
