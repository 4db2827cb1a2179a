#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/mapping/laser_points.h>
#include <Eigen/Core>

#include <cmath>
#include <cstdlib>
#include <limits>

namespace submap_slam {

/** Bounding box of points. */
struct Bounds {
  Eigen::Vector2d min = Eigen::Vector2d::Constant(1e300), max = Eigen::Vector2d::Constant(-1e300);

  void add(const Eigen::Vector2d& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  bool empty() const { return min.x() > max.x(); }
};

/** Calls f(from, to, is_hit) for each beam in the map frame; a longer one is cut at `max_range` (m). */
template <class F>
void forEachBeam(const LaserPoints& scan, const mrpt::math::TPose2D& T_s_robot, double max_range, F f) {
  const double c = std::cos(T_s_robot.phi), s = std::sin(T_s_robot.phi);
  const auto toMap = [&](double x, double y) {
    return Eigen::Vector2d(T_s_robot.x + c * x - s * y, T_s_robot.y + s * x + c * y);
  };
  for (const auto& sweep : scan.sweeps) {
    const Eigen::Vector2d from = toMap(sweep.origin.x(), sweep.origin.y());
    for (std::size_t i = sweep.begin; i < sweep.end; ++i) {
      const auto& p = scan.points[i];
      const Eigen::Vector2d to = toMap(static_cast<double>(p.x), static_cast<double>(p.y));
      const double range = (to - from).norm();
      if (range <= max_range)
        f(from, to, true);
      else
        f(from, Eigen::Vector2d(from + (to - from) * (max_range / range)), false);
    }
  }
}

/** Calls f(column, row) for every cell that the segment crosses, the cell of `to` excluded (Amanatides and
 * Woo, 1987). Coordinates in cells from the grid's corner. */
template <class F>
void forEachCrossedCell(const Eigen::Vector2d& from, const Eigen::Vector2d& to, F f) {
  int cx = static_cast<int>(std::floor(from.x())), cy = static_cast<int>(std::floor(from.y()));
  const int end_x = static_cast<int>(std::floor(to.x())), end_y = static_cast<int>(std::floor(to.y()));
  const Eigen::Vector2d d = to - from;
  const int step_x = d.x() > 0 ? 1 : -1, step_y = d.y() > 0 ? 1 : -1;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double delta_x = d.x() != 0 ? std::abs(1 / d.x()) : kNever;
  const double delta_y = d.y() != 0 ? std::abs(1 / d.y()) : kNever;
  double next_x = d.x() != 0 ? (d.x() > 0 ? cx + 1 - from.x() : from.x() - cx) * delta_x : kNever;
  double next_y = d.y() != 0 ? (d.y() > 0 ? cy + 1 - from.y() : from.y() - cy) * delta_y : kNever;
  for (int left = std::abs(end_x - cx) + std::abs(end_y - cy); left > 0; --left) {
    f(cx, cy);
    if (next_x < next_y) {
      cx += step_x;
      next_x += delta_x;
    } else {
      cy += step_y;
      next_y += delta_y;
    }
  }
}

}  // namespace submap_slam
