#include <submap_slam/mapping/evidence_renderer.h>

#include <cmath>

#include "beam_writer.h"

namespace submap_slam {
namespace {

/** The two arrays of a grid that is large enough for all that is drawn. */
class GridCells {
 public:
  explicit GridCells(EvidenceGrid& grid)
      : columns_(static_cast<int>(grid.sizeX())),
        log_odds_(&*grid.log_odds.begin()),
        hits_(&*grid.hits.begin()) {}

  void add(int column, int row, float log_odds, float hits) {
    const std::ptrdiff_t cell = static_cast<std::ptrdiff_t>(row) * columns_ + column;
    log_odds_[cell] += log_odds;
    hits_[cell] += hits;
  }

 private:
  int columns_;
  float* log_odds_;
  float* hits_;
};

EvidenceGrid gridAround(const Bounds& bounds, double r) {
  const double margin = 2 * r;
  const auto down = [r](double v) { return std::floor(v / r) * r; };
  const auto up = [r](double v) { return std::ceil(v / r) * r; };
  return {down(bounds.min.x() - margin), up(bounds.max.x() + margin), down(bounds.min.y() - margin),
          up(bounds.max.y() + margin), r};
}

}  // namespace

EvidenceGrid renderEvidence(const std::vector<PlacedScan>& scans, const EvidenceParams& params) {
  Bounds bounds;
  for (const auto& scan : scans)
    forEachBeam(*scan.scan, scan.pose, params.max_range,
                [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool) {
                  bounds.add(from);
                  bounds.add(to);
                });
  const double r = params.resolution;
  if (bounds.empty()) return EvidenceGrid(0, r, 0, r, r);
  EvidenceGrid grid = gridAround(bounds, r);
  const Eigen::Vector2d corner(grid.hits.getXMin(), grid.hits.getYMin());
  GridCells cells(grid);
  for (const auto& scan : scans) drawScan(*scan.scan, scan.pose, params, corner, cells);
  return grid.cropped();
}

}  // namespace submap_slam
