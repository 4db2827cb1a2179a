#include <submap_slam/mapping/evidence_renderer.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace submap_slam {
namespace {

using Eigen::Vector2d;

/** Writes beams into the two arrays of a grid; coordinates are in cells from the grid's corner. */
class BeamWriter {
 public:
  BeamWriter(EvidenceGrid& grid, const EvidenceParams& params)
      : params_(params),
        nx_(static_cast<int>(grid.sizeX())),
        log_odds_(&*grid.log_odds.begin()),
        hits_(&*grid.hits.begin()) {}

  /** Free evidence to every cell that the segment crosses, the cell of `to` excluded (Amanatides and Woo,
   * 1987). */
  void crossFree(const Vector2d& from, const Vector2d& to) {
    int cx = static_cast<int>(std::floor(from.x())), cy = static_cast<int>(std::floor(from.y()));
    const int end_x = static_cast<int>(std::floor(to.x())), end_y = static_cast<int>(std::floor(to.y()));
    const Vector2d d = to - from;
    const int step_x = d.x() > 0 ? 1 : -1, step_y = d.y() > 0 ? 1 : -1;
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const double delta_x = d.x() != 0 ? std::abs(1 / d.x()) : kNever;
    const double delta_y = d.y() != 0 ? std::abs(1 / d.y()) : kNever;
    double next_x = d.x() != 0 ? (d.x() > 0 ? cx + 1 - from.x() : from.x() - cx) * delta_x : kNever;
    double next_y = d.y() != 0 ? (d.y() > 0 ? cy + 1 - from.y() : from.y() - cy) * delta_y : kNever;
    const auto free = static_cast<float>(params_.free_log_odds);
    for (int left = std::abs(end_x - cx) + std::abs(end_y - cy); left > 0; --left) {
      add(cx, cy, free, 1.0f);
      if (next_x < next_y) {
        cx += step_x;
        next_x += delta_x;
      } else {
        cy += step_y;
        next_y += delta_y;
      }
    }
  }

  /** Occupied evidence of one observation, shared bilinearly by the four cells around the endpoint. */
  void hitAt(const Vector2d& p) {
    const double x = p.x() - 0.5, y = p.y() - 0.5;  // cell centres
    const int cx = static_cast<int>(std::floor(x)), cy = static_cast<int>(std::floor(y));
    const double u = x - cx, v = y - cy;
    const double weights[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
    for (int k = 0; k < 4; ++k)
      add(cx + (k & 1), cy + (k >> 1), static_cast<float>(weights[k] * params_.occupied_log_odds),
          static_cast<float>(weights[k]));
  }

 private:
  void add(int cx, int cy, float log_odds, float hits) {
    const std::ptrdiff_t cell = static_cast<std::ptrdiff_t>(cy) * nx_ + cx;
    log_odds_[cell] += log_odds;
    hits_[cell] += hits;
  }

  const EvidenceParams& params_;
  int nx_;
  float* log_odds_;
  float* hits_;
};

/** Bounding box of all beams, each cut at the maximum range. */
struct Bounds {
  Vector2d min = Vector2d::Constant(1e300), max = Vector2d::Constant(-1e300);
  void add(const Vector2d& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
};

/** Calls f(from, to, is_hit) for each beam in the map frame. */
template <class F>
void forEachBeam(const PlacedScan& placed, double max_range, F f) {
  const double c = std::cos(placed.pose.phi), s = std::sin(placed.pose.phi);
  const auto toMap = [&](double x, double y) {
    return Vector2d(placed.pose.x + c * x - s * y, placed.pose.y + s * x + c * y);
  };
  for (const auto& sweep : placed.scan->sweeps) {
    const Vector2d from = toMap(sweep.origin.x(), sweep.origin.y());
    for (std::size_t i = sweep.begin; i < sweep.end; ++i) {
      const auto& p = placed.scan->points[i];
      const Vector2d to = toMap(static_cast<double>(p.x), static_cast<double>(p.y));
      const double range = (to - from).norm();
      if (range <= max_range)
        f(from, to, true);
      else
        f(from, from + (to - from) * (max_range / range), false);
    }
  }
}

}  // namespace

EvidenceGrid renderEvidence(const std::vector<PlacedScan>& scans, const EvidenceParams& params) {
  Bounds bounds;
  for (const auto& scan : scans)
    forEachBeam(scan, params.max_range, [&](const Vector2d& from, const Vector2d& to, bool) {
      bounds.add(from);
      bounds.add(to);
    });
  const double r = params.resolution;
  if (bounds.min.x() > bounds.max.x()) return EvidenceGrid(0, r, 0, r, r);
  const double margin = 2 * r;
  const auto down = [r](double v) { return std::floor(v / r) * r; };
  const auto up = [r](double v) { return std::ceil(v / r) * r; };
  EvidenceGrid grid(down(bounds.min.x() - margin), up(bounds.max.x() + margin), down(bounds.min.y() - margin),
                    up(bounds.max.y() + margin), r);
  const Vector2d corner(grid.hits.getXMin(), grid.hits.getYMin());
  BeamWriter writer(grid, params);
  for (const auto& scan : scans)
    forEachBeam(scan, params.max_range, [&](const Vector2d& from, const Vector2d& to, bool is_hit) {
      const Vector2d a = (from - corner) / r, b = (to - corner) / r;
      writer.crossFree(a, b);
      if (is_hit) writer.hitAt(b);
    });
  return grid.cropped();
}

}  // namespace submap_slam
