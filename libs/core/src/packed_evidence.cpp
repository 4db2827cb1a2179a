#include <submap_slam/core/packed_evidence.h>

#include <algorithm>

namespace submap_slam {

PackedEvidence::PackedEvidence(const EvidenceGrid& grid)
    : x_min_(grid.hits.getXMin()),
      y_min_(grid.hits.getYMin()),
      x_max_(grid.hits.getXMax()),
      y_max_(grid.hits.getYMax()),
      resolution_(grid.resolution()),
      nx_(grid.sizeX()),
      ny_(grid.sizeY()),
      columns_(static_cast<int>((nx_ + kMask) / kSide)),
      rows_(static_cast<int>((ny_ + kMask) / kSide)),
      numbers_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1),
      reach_(static_cast<std::size_t>(columns_ + 1) * static_cast<std::size_t>(rows_ + 1), 0) {
  for (int by = 0; by < rows_; ++by)
    for (int bx = 0; bx < columns_; ++bx) addBlock(grid, bx, by);
  cells_.shrink_to_fit();
}

void PackedEvidence::addBlock(const EvidenceGrid& grid, int bx, int by) {
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
  if (!observed) return;
  numbers_[static_cast<std::size_t>(by) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(bx)] =
      static_cast<int32_t>(cells_.size());
  cells_.push_back(block);
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
      const auto x0 = static_cast<std::size_t>(bx * kSide), y0 = static_cast<std::size_t>(by * kSide);
      const std::size_t width = std::min<std::size_t>(kSide, nx_ - x0);
      for (std::size_t y = 0; y < kSide && y0 + y < ny_; ++y) {
        const auto to = static_cast<std::ptrdiff_t>((y0 + y) * nx_ + x0);
        std::copy_n(block->log_odds.begin() + y * kSide, width, grid.log_odds.begin() + to);
        std::copy_n(block->hits.begin() + y * kSide, width, grid.hits.begin() + to);
      }
    }
  return grid;
}

}  // namespace submap_slam
