#include <submap_slam/core/packed_evidence.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "grid_limits.h"

namespace submap_slam {

PackedEvidence::PackedEvidence(double x_min, double x_max, double y_min, double y_max, double resolution,
                               std::size_t nx, std::size_t ny)
    : x_min_(x_min),
      y_min_(y_min),
      x_max_(x_max),
      y_max_(y_max),
      resolution_(resolution),
      nx_(nx),
      ny_(ny),
      columns_(static_cast<int>((nx_ + kMask) / kSide)),
      rows_(static_cast<int>((ny_ + kMask) / kSide)),
      numbers_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1),
      reach_(static_cast<std::size_t>(columns_ + 1) * static_cast<std::size_t>(rows_ + 1), 0) {}

PackedEvidence::PackedEvidence(const EvidenceLayer& along_x, const EvidenceLayer& along_y)
    : PackedEvidence(along_x.getXMin(), along_x.getXMax(), along_y.getYMin(), along_y.getYMax(),
                     along_x.getResolution(), along_x.getSizeX(), along_y.getSizeY()) {}

PackedEvidence::PackedEvidence(double x_min, double x_max, double y_min, double y_max, double resolution)
    : PackedEvidence(EvidenceGrid(x_min, x_max, 0, resolution, resolution).hits,
                     EvidenceGrid(0, resolution, y_min, y_max, resolution).hits) {
  cells_.reserve(numbers_.size());  // room that a copy of the grid does not have
}

PackedEvidence::PackedEvidence(const EvidenceGrid& grid) : PackedEvidence(grid.hits, grid.hits) {
  for (int by = 0; by < rows_; ++by)
    for (int bx = 0; bx < columns_; ++bx) packBlock(grid, bx, by);
  cells_.shrink_to_fit();
}

void PackedEvidence::packBlock(const EvidenceGrid& grid, int bx, int by) {
  Block block;
  bool observed = false;
  const auto x0 = static_cast<std::size_t>(bx * kSide), y0 = static_cast<std::size_t>(by * kSide);
  for (std::size_t y = 0; y < kSide && y0 + y < ny_; ++y)
    for (std::size_t x = 0; x < kSide && x0 + x < nx_; ++x) {
      const std::size_t from = (y0 + y) * nx_ + x0 + x, to = y * kSide + x;
      block.log_odds[to] = grid.log_odds.data()[from];
      block.hits[to] = grid.hits.data()[from];
      observed = observed || block.hits[to] != 0 || block.log_odds[to] != 0;
    }
  if (observed) store(block, bx, by);
}

void PackedEvidence::store(const Block& block, int bx, int by) {
  place(cells_.size(), bx, by);
  cells_.push_back(block);
}

/** Tells where the block with that number is. */
void PackedEvidence::place(std::size_t number, int bx, int by) {
  numbers_[tableIndex(bx, by)] = static_cast<int32_t>(number);
  for (const int y : {by, by + 1})  // also reached from the last cells of the blocks before it
    for (const int x : {bx, bx + 1})
      reach_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_ + 1) +
             static_cast<std::size_t>(x)] = 1;
}

EvidenceGrid PackedEvidence::unpacked() const {
  EvidenceGrid grid(x_min_, x_max_, y_min_, y_max_, resolution_);
  for (int by = 0; by < rows_; ++by)
    for (int bx = 0; bx < columns_; ++bx) {
      const Block* block = blockAt(bx, by);
      if (!block) continue;
      const int x0 = bx * kSide, y0 = by * kSide, width = std::min(kSide, sizeX() - x0);
      for (int y = y0; y < std::min(sizeY(), y0 + kSide); ++y) {
        const auto to = static_cast<std::ptrdiff_t>(y) * sizeX() + x0;
        const auto from = (y - y0) * kSide;
        std::copy_n(block->log_odds.begin() + from, width, grid.log_odds.begin() + to);
        std::copy_n(block->hits.begin() + from, width, grid.hits.begin() + to);
      }
    }
  return grid;
}

mrpt::maps::COccupancyGridMap2D PackedEvidence::toOccupancyGrid() const {
  mrpt::maps::COccupancyGridMap2D map(static_cast<float>(x_min_), static_cast<float>(x_max_),
                                      static_cast<float>(y_min_), static_cast<float>(y_max_),
                                      static_cast<float>(resolution_));  // all cells 0.5
  forEachObserved([&map](int cx, int cy, float log_odds, float) {
    map.setCell(cx, cy, static_cast<float>(1.0 - occupancyOf(log_odds)));
  });
  return map;
}

std::size_t PackedEvidence::observedCells() const {
  std::size_t cells = 0;
  forEachObserved([&cells](int, int, float, float) { ++cells; });
  return cells;
}

CellRange PackedEvidence::observedRange() const {
  CellRange range{sizeX(), -1, sizeY(), -1};
  forEachObserved([&range](int cx, int cy, float, float) {
    range.x_first = std::min(range.x_first, cx), range.x_last = std::max(range.x_last, cx);
    range.y_first = std::min(range.y_first, cy), range.y_last = std::max(range.y_last, cy);
  });
  return range;
}

std::size_t PackedEvidence::bytes() const {
  return sizeof(*this) + cells_.capacity() * sizeof(Block) + numbers_.capacity() * sizeof(int32_t) +
         reach_.capacity();
}

/** Positions of the stored blocks, row by row. */
std::vector<uint32_t> PackedEvidence::storedPositions() const {
  std::vector<uint32_t> positions;
  positions.reserve(cells_.size());
  for (std::size_t k = 0; k < numbers_.size(); ++k)
    if (numbers_[k] >= 0) positions.push_back(static_cast<uint32_t>(k));
  return positions;
}

void PackedEvidence::writeTo(mrpt::serialization::CArchive& out) const {
  const std::vector<uint32_t> positions = storedPositions();
  out << x_min_ << x_max_ << y_min_ << y_max_ << resolution_ << static_cast<uint32_t>(nx_)
      << static_cast<uint32_t>(ny_) << static_cast<uint32_t>(positions.size());
  if (positions.empty()) return;
  out.WriteBufferFixEndianness(positions.data(), positions.size());
  for (const uint32_t position : positions) {
    const Block& block = cells_[static_cast<std::size_t>(numbers_[position])];
    out.WriteBufferFixEndianness(block.log_odds.data(), sizeof(Block) / sizeof(float));
  }
}

PackedEvidence PackedEvidence::readFrom(mrpt::serialization::CArchive& in) {
  double x_min = 0, x_max = 0, y_min = 0, y_max = 0, resolution = 0;
  uint32_t nx = 0, ny = 0, blocks = 0;
  in >> x_min >> x_max >> y_min >> y_max >> resolution >> nx >> ny >> blocks;
  const auto spans = [&](double min, double max, uint32_t cells) {
    return cells > 0 && cells <= kMaxSide && std::abs((max - min) / resolution - cells) < 0.01;
  };
  if (!(resolution > 0) || !spans(x_min, x_max, nx) || !spans(y_min, y_max, ny))
    throw std::runtime_error("evidence with implausible limits");
  PackedEvidence packed(x_min, x_max, y_min, y_max, resolution, nx, ny);
  if (blocks > packed.numbers_.size()) throw std::runtime_error("evidence with too many blocks");
  if (blocks == 0) return packed;
  std::vector<uint32_t> positions(blocks);
  in.ReadBufferFixEndianness(positions.data(), positions.size());
  packed.cells_.resize(blocks);
  for (std::size_t k = 0; k < blocks; ++k) {
    if (positions[k] >= packed.numbers_.size() || (k > 0 && positions[k] <= positions[k - 1]))
      throw std::runtime_error("evidence with blocks in the wrong places");
    const auto columns = static_cast<uint32_t>(packed.columns_);
    packed.place(k, static_cast<int>(positions[k] % columns), static_cast<int>(positions[k] / columns));
  }
  static_assert(sizeof(Block) == 2 * kSide * kSide * sizeof(float), "blocks lie one behind the other");
  in.ReadBufferFixEndianness(packed.cells_.front().log_odds.data(), blocks * sizeof(Block) / sizeof(float));
  return packed;
}

}  // namespace submap_slam
