#include <submap_slam/core/evidence_grid.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "grid_limits.h"

namespace submap_slam {
namespace {

using Grid = mrpt::containers::CDynamicGrid<float>;

/** A limit this close to a multiple of the resolution (in cells) is that multiple. */
constexpr double kSameLimit = 1e-6;

double roundedDown(double limit, double r) { return std::floor(limit / r + kSameLimit) * r; }
double roundedUp(double limit, double r) { return std::ceil(limit / r - kSameLimit) * r; }

struct CellBox {
  std::size_t x0, x1, y0, y1;  // inclusive
};

/** Bounds of the observed cells; false if there are none. */
bool observedBox(const Grid& hits, CellBox& box) {
  box = {hits.getSizeX(), 0, hits.getSizeY(), 0};
  bool any = false;
  const float* cell = hits.data().data();
  for (std::size_t cy = 0; cy < hits.getSizeY(); ++cy)
    for (std::size_t cx = 0; cx < hits.getSizeX(); ++cx, ++cell)
      if (*cell > 0) {
        box = {std::min(box.x0, cx), std::max(box.x1, cx), std::min(box.y0, cy), std::max(box.y1, cy)};
        any = true;
      }
  return any;
}

void copyBox(const Grid& from, const CellBox& box, Grid& to) {
  for (std::size_t cy = box.y0; cy <= box.y1; ++cy) {
    const float* row = from.data().data() + cy * from.getSizeX();
    std::copy(row + box.x0, row + box.x1 + 1,
              to.begin() + static_cast<std::ptrdiff_t>((cy - box.y0) * to.getSizeX()));
  }
}

void writeCells(mrpt::serialization::CArchive& out, const Grid& grid) {
  out.WriteBufferFixEndianness(grid.data().data(), grid.data().size());
}

void readCells(mrpt::serialization::CArchive& in, Grid& grid) {
  std::vector<float> cells(grid.data().size());
  in.ReadBufferFixEndianness(cells.data(), cells.size());
  std::copy(cells.begin(), cells.end(), grid.begin());
}

}  // namespace

void EvidenceLayer::swap(EvidenceLayer& other) noexcept {
  std::swap(m_map, other.m_map);
  std::swap(m_x_min, other.m_x_min), std::swap(m_x_max, other.m_x_max);
  std::swap(m_y_min, other.m_y_min), std::swap(m_y_max, other.m_y_max);
  std::swap(m_resolution, other.m_resolution);
  std::swap(m_size_x, other.m_size_x), std::swap(m_size_y, other.m_size_y);
}

EvidenceGrid::EvidenceGrid() : EvidenceGrid(0, 1, 0, 1, 1) {}

EvidenceGrid::EvidenceGrid(double x_min, double x_max, double y_min, double y_max, double resolution)
    : log_odds(roundedDown(x_min, resolution), roundedUp(x_max, resolution), roundedDown(y_min, resolution),
               roundedUp(y_max, resolution), resolution),
      hits(log_odds.getXMin(), log_odds.getXMax(), log_odds.getYMin(), log_odds.getYMax(), resolution) {
  log_odds.fill(0.0f);
  hits.fill(0.0f);
}

std::size_t EvidenceGrid::observedCells() const {
  return static_cast<std::size_t>(std::count_if(hits.begin(), hits.end(), [](float n) { return n > 0; }));
}

EvidenceGrid EvidenceGrid::cropped() const {
  CellBox box{};
  const double r = resolution();
  if (!observedBox(hits, box)) return EvidenceGrid(0, r, 0, r, r);
  const auto at = [r](double min, std::size_t cells) { return min + r * static_cast<double>(cells); };
  EvidenceGrid out(at(hits.getXMin(), box.x0), at(hits.getXMin(), box.x1 + 1), at(hits.getYMin(), box.y0),
                   at(hits.getYMin(), box.y1 + 1), r);
  copyBox(log_odds, box, out.log_odds);
  copyBox(hits, box, out.hits);
  return out;
}

void EvidenceGrid::writeTo(mrpt::serialization::CArchive& out) const {
  out << log_odds.getXMin() << log_odds.getYMin() << resolution() << static_cast<uint32_t>(sizeX())
      << static_cast<uint32_t>(sizeY());
  writeCells(out, log_odds);
  writeCells(out, hits);
}

EvidenceGrid EvidenceGrid::readFrom(mrpt::serialization::CArchive& in) {
  double x_min = 0, y_min = 0, r = 0;
  uint32_t nx = 0, ny = 0;
  in >> x_min >> y_min >> r >> nx >> ny;
  if (!(r > 0) || !std::isfinite(x_min) || !std::isfinite(y_min) || nx == 0 || ny == 0 || nx > kMaxSide ||
      ny > kMaxSide)
    throw std::runtime_error("evidence grid with an implausible size");
  EvidenceGrid grid(x_min, x_min + nx * r, y_min, y_min + ny * r, r);
  if (grid.sizeX() != nx || grid.sizeY() != ny)
    throw std::runtime_error("evidence grid limits do not match its size");
  readCells(in, grid.log_odds);
  readCells(in, grid.hits);
  return grid;
}

double occupancyOf(float log_odds) { return 1.0 / (1.0 + std::exp(-static_cast<double>(log_odds))); }

}  // namespace submap_slam
