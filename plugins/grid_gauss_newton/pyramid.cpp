#include "pyramid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace submap_slam::grid_joining {

EvidenceLevel::EvidenceLevel(double x0, double y0, double resolution, int columns, int rows)
    : x0_(x0),
      y0_(y0),
      resolution_(resolution),
      columns_(columns),
      rows_(rows),
      cells_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

EvidenceLevel EvidenceLevel::fromGrid(const EvidenceGrid& grid) {
  const int nx = static_cast<int>(grid.sizeX()), ny = static_cast<int>(grid.sizeY());
  int left = nx, right = -1, bottom = ny, top = -1;
  auto hits = grid.hits.begin();
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x, ++hits) {
      if (*hits <= 0) continue;
      left = std::min(left, x), right = std::max(right, x), bottom = std::min(bottom, y),
      top = std::max(top, y);
    }
  if (right < left) return {};

  EvidenceLevel level(grid.log_odds.idx2x(left - 1), grid.log_odds.idx2y(bottom - 1), grid.resolution(),
                      right - left + 3, top - bottom + 3);
  for (int y = bottom; y <= top; ++y)
    for (int x = left; x <= right; ++x) {
      const std::size_t source = static_cast<std::size_t>(y) * grid.sizeX() + static_cast<std::size_t>(x);
      if (grid.hits.data()[source] <= 0) continue;
      level.mutableCell(x - left + 1, y - bottom + 1) = {grid.log_odds.data()[source],
                                                         grid.hits.data()[source]};
    }
  return level;
}

EvidenceLevel EvidenceLevel::halved() const {
  if (empty()) return {};
  // Cell 1 of the coarse level holds cells 1 and 2 of this one; cell 0 stays the rim.
  const int inner_columns = (columns_ - 1) / 2, inner_rows = (rows_ - 1) / 2;
  EvidenceLevel coarse(x0_ - 0.5 * resolution_, y0_ - 0.5 * resolution_, 2 * resolution_, inner_columns + 2,
                       inner_rows + 2);
  for (int r = 1; r < rows_ - 1; ++r)
    for (int c = 1; c < columns_ - 1; ++c) {
      EvidenceCell& sum = coarse.mutableCell((c + 1) / 2, (r + 1) / 2);
      sum.log_odds += cell(c, r).log_odds;
      sum.hits += cell(c, r).hits;
    }
  return coarse;
}

void EvidenceLevel::standardise() {
  for (EvidenceCell& c : cells_) {
    if (c.hits <= 0) continue;
    c.hits = std::sqrt(c.hits);
    c.log_odds /= c.hits;
  }
}

std::vector<EvidenceLevels> buildPyramid(const GridSubmaps& submaps, int finest_level, int levels) {
  std::vector<std::vector<EvidenceLevel>> of_submap(submaps.size());
  tbb::parallel_for(std::size_t{0}, submaps.size(), [&](std::size_t i) {
    EvidenceLevel level = EvidenceLevel::fromGrid(submaps[i]->evidence);
    for (int k = 0; k < finest_level; ++k) level = level.halved();
    for (int k = 0; k < levels; ++k) {
      EvidenceLevel coarser = k + 1 < levels ? level.halved() : level;
      if (k > 0) level.standardise();
      of_submap[i].push_back(std::exchange(level, std::move(coarser)));
    }
  });

  std::vector<EvidenceLevels> pyramid(static_cast<std::size_t>(levels));
  for (auto& stack : of_submap)
    for (std::size_t k = 0; k < stack.size(); ++k) pyramid[k].push_back(std::move(stack[k]));
  return pyramid;
}

}  // namespace submap_slam::grid_joining
