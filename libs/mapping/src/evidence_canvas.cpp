#include "evidence_canvas.h"

#include <cmath>

namespace submap_slam {
namespace {

using Eigen::Vector2d;
using mrpt::math::TPose2D;

EvidenceGrid gridAround(const Bounds& bounds, double r) {
  const double margin = 2 * r;
  const auto down = [r](double v) { return std::floor(v / r) * r; };
  const auto up = [r](double v) { return std::ceil(v / r) * r; };
  return {down(bounds.min.x() - margin), up(bounds.max.x() + margin), down(bounds.min.y() - margin),
          up(bounds.max.y() + margin), r};
}

/** Writes beams into the two arrays of a grid; coordinates are in cells from the grid's corner. */
class BeamWriter {
 public:
  BeamWriter(EvidenceGrid& grid, const EvidenceParams& params)
      : params_(params),
        nx_(static_cast<int>(grid.sizeX())),
        log_odds_(&*grid.log_odds.begin()),
        hits_(&*grid.hits.begin()) {}

  /** Free evidence to every cell that the segment crosses, the cell of `to` excluded. */
  void crossFree(const Vector2d& from, const Vector2d& to) {
    const auto free = static_cast<float>(params_.free_log_odds);
    forEachCrossedCell(from, to, [&](int cx, int cy) { add(cx, cy, free, 1.0f); });
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

}  // namespace

void addBounds(Bounds& bounds, const LaserPoints& scan, const TPose2D& pose, const EvidenceParams& params) {
  forEachBeam(scan, pose, params.max_range, [&](const Vector2d& from, const Vector2d& to, bool) {
    bounds.add(from);
    bounds.add(to);
  });
}

EvidenceCanvas::EvidenceCanvas(const Bounds& bounds, const EvidenceParams& params)
    : params_(params), grid_(gridAround(bounds, params.resolution)) {}

void EvidenceCanvas::draw(const LaserPoints& scan, const TPose2D& pose) {
  const double r = params_.resolution;
  const Vector2d corner(grid_.hits.getXMin(), grid_.hits.getYMin());
  BeamWriter writer(grid_, params_);
  forEachBeam(scan, pose, params_.max_range, [&](const Vector2d& from, const Vector2d& to, bool is_hit) {
    const Vector2d a = (from - corner) / r, b = (to - corner) / r;
    writer.crossFree(a, b);
    if (is_hit) writer.hitAt(b);
  });
}

}  // namespace submap_slam
