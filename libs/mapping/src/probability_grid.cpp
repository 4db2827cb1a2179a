#include <submap_slam/mapping/probability_grid.h>

#include <cmath>

#include "beam_tracing.h"

namespace submap_slam {

using Eigen::Vector2d;

ProbabilityGrid::ProbabilityGrid(const ProbabilityGridParams& params)
    : params_(params), cells_(0, 0, 0, 0, params.resolution) {}

void ProbabilityGrid::growTo(double x_min, double y_min, double x_max, double y_max) {
  if (x_min >= cells_.getXMin() && y_min >= cells_.getYMin() && x_max <= cells_.getXMax() &&
      y_max <= cells_.getYMax())
    return;
  constexpr double kMargin = 4.0;  // m, so that it grows seldom
  const double r = params_.resolution;
  const auto down = [r](double v) { return std::floor((v - kMargin) / r) * r; };
  const auto up = [r](double v) { return std::ceil((v + kMargin) / r) * r; };
  cells_.resize(down(x_min), up(x_max), down(y_min), up(y_max), Cell{}, 0);
}

void ProbabilityGrid::update(int column, int row, double odds_factor) {
  Cell& cell = *cells_.cellByIndex(static_cast<unsigned>(column), static_cast<unsigned>(row));
  if (cell.insertion == insertion_) return;
  cell.insertion = insertion_;
  const double before = cell.probability > 0 ? odds(static_cast<double>(cell.probability)) : 1.0;
  cell.probability =
      static_cast<float>(std::clamp(probabilityOf(before * odds_factor), params_.min, params_.max));
}

void ProbabilityGrid::insert(const LaserPoints& scan, const mrpt::math::TPose2D& T_s_robot,
                             double max_range) {
  Bounds bounds;
  forEachBeam(scan, T_s_robot, max_range, [&](const Vector2d& from, const Vector2d& to, bool) {
    bounds.add(from);
    bounds.add(to);
  });
  if (bounds.empty()) return;
  growTo(bounds.min.x(), bounds.min.y(), bounds.max.x(), bounds.max.y());
  ++insertion_;
  const Vector2d corner(cells_.getXMin(), cells_.getYMin());
  const auto cellsFrom = [&](const Vector2d& p) { return Vector2d((p - corner) / params_.resolution); };
  // Hits first: a beam that passes close to a surface does not take away what another one ends on.
  forEachBeam(scan, T_s_robot, max_range, [&](const Vector2d&, const Vector2d& to, bool is_hit) {
    const Vector2d end = cellsFrom(to);
    if (is_hit) update(static_cast<int>(end.x()), static_cast<int>(end.y()), odds(params_.hit));
  });
  forEachBeam(scan, T_s_robot, max_range, [&](const Vector2d& from, const Vector2d& to, bool) {
    forEachCrossedCell(cellsFrom(from), cellsFrom(to),
                       [&](int column, int row) { update(column, row, odds(params_.miss)); });
  });
}

}  // namespace submap_slam
