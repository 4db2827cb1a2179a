#include "synthetic_submaps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace submap_slam::testing {
namespace {

double distanceTo(const Wall& wall, double x, double y) {
  const double dx = wall.x1 - wall.x0, dy = wall.y1 - wall.y0;
  const double share = std::clamp(((x - wall.x0) * dx + (y - wall.y0) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return std::hypot(x - wall.x0 - share * dx, y - wall.y0 - share * dy);
}

double distanceTo(const World& world, double x, double y) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& wall : world) nearest = std::min(nearest, distanceTo(wall, x, y));
  return nearest;
}

/** Whether the wall stands between two points. */
bool hides(const Wall& wall, const mrpt::math::TPoint2D& from, const mrpt::math::TPoint2D& to) {
  const double dx = to.x - from.x, dy = to.y - from.y, wx = wall.x1 - wall.x0, wy = wall.y1 - wall.y0;
  const double cross = dx * wy - dy * wx;
  if (cross == 0) return false;
  const double along_ray = ((wall.x0 - from.x) * wy - (wall.y0 - from.y) * wx) / cross;
  const double along_wall = ((wall.x0 - from.x) * dy - (wall.y0 - from.y) * dx) / cross;
  return along_ray > 0 && along_ray < 1 && along_wall > 0 && along_wall < 1;
}

/** Portable: the standard distributions differ between libraries. */
double uniform(std::mt19937& generator) { return static_cast<double>(generator()) / 4294967296.0; }

/** Calls evidence(x, y) → (log-odds per hit, hits) at each cell centre. */
template <class Evidence>
void fill(EvidenceGrid& grid, Evidence evidence) {
  for (unsigned cy = 0; cy < grid.sizeY(); ++cy)
    for (unsigned cx = 0; cx < grid.sizeX(); ++cx) {
      const auto [log_odds, hits] =
          evidence(grid.log_odds.idx2x(static_cast<int>(cx)), grid.log_odds.idx2y(static_cast<int>(cy)));
      if (hits <= 0) continue;
      *grid.log_odds.cellByIndex(cx, cy) = static_cast<float>(log_odds * hits);
      *grid.hits.cellByIndex(cx, cy) = static_cast<float>(hits);
    }
}

}  // namespace

World room() {
  return {{-5, -4, 5, -4},      {5, -4, 5, 4},         {5, 4, -5, 4},       {-5, 4, -5, -4},
          {-2, -4, -2, -2.5},   {-2, -2.5, -1, -2.5},  {1.5, 4, 1.5, 2.6},  {3, 0.4, 4.1, 1.3},
          {-3.6, 1, -2.9, 2.2}, {-0.4, 1.1, 0.6, 0.7}, {2.2, -2.1, 3, -3.2}};
}

World corridor(double length) {
  return {{-0.5 * length, -1, 0.5 * length, -1}, {-0.5 * length, 1, 0.5 * length, 1}};
}

GridSubmap::Ptr renderSubmap(const World& world, const mrpt::math::TPose2D& T_w_s, double range,
                             double resolution, double noise, uint32_t seed) {
  auto submap = GridSubmap::Create();
  submap->evidence = EvidenceGrid(-range, range, -range, range, resolution);
  std::mt19937 generator(seed);
  fill(submap->evidence, [&](double x, double y) {
    const double away = std::hypot(x, y);
    const mrpt::math::TPoint2D global = T_w_s.composePoint({x, y});
    const double wall = distanceTo(world, global.x, global.y) / 0.06;
    const double sum_of_12 = [&] {
      double sum = -6;
      for (int k = 0; k < 12; ++k) sum += uniform(generator);
      return sum;
    }();
    const double log_odds = 3 * std::exp(-0.5 * wall * wall) - 1 + noise * sum_of_12;
    return std::pair(log_odds, away > range ? 0.0 : std::floor(2 + 18 * (1 - away / range)));
  });
  return submap;
}

void linkChain(const GridSubmaps& submaps, const std::vector<mrpt::math::TPose2D>& true_frames,
               double sigma_m, double sigma_rad) {
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    submaps[k]->id = static_cast<uint32_t>(k);
    submaps[k]->has_successor = k + 1 < submaps.size();
    if (!submaps[k]->has_successor) continue;
    submaps[k]->end_pose.mean = mrpt::poses::CPose2D(true_frames[k + 1] - true_frames[k]);
    submaps[k]->end_pose.cov.setZero();
    submaps[k]->end_pose.cov(0, 0) = submaps[k]->end_pose.cov(1, 1) = sigma_m * sigma_m;
    submaps[k]->end_pose.cov(2, 2) = sigma_rad * sigma_rad;
  }
}

GridSubmap::Ptr scanSubmap(const World& world, const mrpt::math::TPose2D& T_w_s, double range,
                           double resolution, double noise, uint32_t seed) {
  constexpr double kIntoWall = 0.15;  // m of a ray that goes on behind the surface
  auto submap = renderSubmap(world, T_w_s, range, resolution, noise, seed);
  EvidenceGrid& grid = submap->evidence;
  for (unsigned cy = 0; cy < grid.sizeY(); ++cy)
    for (unsigned cx = 0; cx < grid.sizeX(); ++cx) {
      const mrpt::math::TPoint2D cell(grid.log_odds.idx2x(static_cast<int>(cx)),
                                      grid.log_odds.idx2y(static_cast<int>(cy)));
      const double seen = std::max(0.0, 1 - kIntoWall / std::max(cell.norm(), kIntoWall));
      const auto from = T_w_s.composePoint({0, 0}), to = T_w_s.composePoint(cell * seen);
      if (std::any_of(world.begin(), world.end(), [&](const Wall& wall) { return hides(wall, from, to); }))
        *grid.log_odds.cellByIndex(cx, cy) = *grid.hits.cellByIndex(cx, cy) = 0;
    }
  return submap;
}

GridSubmap::Ptr landscapeSubmap(const mrpt::math::TPose2D& T_w_s, double range, double resolution) {
  auto submap = GridSubmap::Create();
  submap->evidence = EvidenceGrid(-range, range, -range, range, resolution);
  fill(submap->evidence, [&](double x, double y) {
    const mrpt::math::TPoint2D p = T_w_s.composePoint({x, y});
    const double log_odds = std::sin(0.9 * p.x + 0.4 * p.y) + std::sin(-0.5 * p.x + 1.1 * p.y) +
                            std::sin(1.3 * p.x + 2 * std::sin(0.4 * p.y));
    return std::pair(log_odds, 5.0);
  });
  return submap;
}

GridSubmap::Ptr randomSubmap(uint32_t seed, double width, double height, double resolution) {
  auto submap = GridSubmap::Create();
  submap->id = seed;
  submap->evidence = EvidenceGrid(-0.5 * width, 0.5 * width, -0.5 * height, 0.5 * height, resolution);
  std::mt19937 generator(seed);
  std::vector<double> p(12);
  for (double& value : p) value = 4 * uniform(generator) - 2;
  fill(submap->evidence, [&](double x, double y) {
    const double log_odds =
        std::sin(p[0] * x + p[1] * y + p[2]) + p[3] * std::cos(p[4] * x - p[5] * y) + 0.3 * p[6];
    const double hits = 3 + 2 * std::sin(p[7] * x + p[8]) + 1.5 * std::cos(p[9] * y + p[10] * x + p[11]);
    return std::pair(log_odds, hits);
  });
  return submap;
}

GridSubmap::Ptr roughSubmap(uint32_t seed, double width, double height, double resolution) {
  auto submap = GridSubmap::Create();
  submap->id = seed;
  submap->evidence = EvidenceGrid(-0.5 * width, 0.5 * width, -0.5 * height, 0.5 * height, resolution);
  std::mt19937 generator(seed);
  fill(submap->evidence, [&](double, double) {
    const double log_odds = 6 * uniform(generator) - 3;
    return std::pair(log_odds, std::floor(9 * uniform(generator)));
  });
  return submap;
}

std::vector<mrpt::poses::CPosePDFGaussian> asGaussians(const std::vector<mrpt::math::TPose2D>& frames) {
  std::vector<mrpt::poses::CPosePDFGaussian> result;
  for (const auto& frame : frames) {
    mrpt::poses::CPosePDFGaussian gaussian;
    gaussian.mean = mrpt::poses::CPose2D(frame);
    gaussian.cov.setZero();
    result.push_back(gaussian);
  }
  return result;
}

}  // namespace submap_slam::testing
