#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>
#include <submap_slam/matching/score_pyramid.h>

#include <optional>
#include <vector>

namespace submap_slam {

/** Poses (x, y) within half_xy of the centre along both axes, headings within half_phi. */
struct PoseWindow {
  mrpt::math::TPose2D centre;
  double half_xy = 0;   ///< m
  double half_phi = 0;  ///< rad
};

/** What makes two poses of a window different places. */
struct RivalParams {
  double distance = 1.0;  ///< m
  double turn = 0.3;      ///< rad
  double share = 0.9;     ///< a rival scores at least this share of the best
};

struct WindowMatch {
  mrpt::math::TPose2D pose;  ///< T_map_points: where the points fit best, to a cell of the pyramid
  double score = 0;          ///< mean over the points of what they score there, in [0, 1]
};

/** Levels of a pyramid (cells of `resolution`, m) that the search of a window makes use of. */
int usefulLevels(double half_xy, double resolution);

/** The pose in the window where the points score best, found exactly (on the grid of translations of one cell
 * and turns that move the farthest point by one cell) by branch and bound (Hess et al. 2016, algorithm 3).
 * Empty if nothing reaches `min_score`.
 * @param points in their own frame (m) */
std::optional<WindowMatch> searchWindow(const ScorePyramid& map,
                                        const std::vector<mrpt::math::TPoint2D>& points,
                                        const PoseWindow& window, double min_score);

/** Best score in the window that is farther than `distance` or turned by more than `turn` from what was found
 * in it, if it is a rival; else 0. */
double searchRival(const ScorePyramid& map, const std::vector<mrpt::math::TPoint2D>& points,
                   const PoseWindow& window, const WindowMatch& found, const RivalParams& rivals = {});

}  // namespace submap_slam
