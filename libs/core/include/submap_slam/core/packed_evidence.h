#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/evidence_grid.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace submap_slam {

/** Cells from the first to the last column and row. */
struct CellRange {
  int x_first = 0, x_last = -1, y_first = 0, y_last = -1;  ///< the last ones belong to it
  bool empty() const { return x_last < x_first; }
  int columns() const { return x_last - x_first + 1; }
  int rows() const { return y_last - y_first + 1; }
};

/** The observed part of an EvidenceGrid in blocks of 8 × 8 cells; blocks where nothing was observed are not
 * stored. A submap's grid shrinks to a fifth, because its beams leave most of its bounding box unknown, and
 * so does the map of a large site. */
class PackedEvidence {
 public:
  /** One unknown cell. */
  PackedEvidence() : PackedEvidence(0, 1, 0, 1, 1) {}

  /** All cells unknown; the limits are rounded as those of an EvidenceGrid. */
  PackedEvidence(double x_min, double x_max, double y_min, double y_max, double resolution);

  explicit PackedEvidence(const EvidenceGrid& grid);

  /** The grid it was made from, to the last bit. */
  EvidenceGrid unpacked() const;

  /** MRPT's grid: the evidence sum clamped to MRPT's int8 range; unknown cells are 0.5. Its probabilities are
   * those of *free* space, as in MRPT. */
  mrpt::maps::COccupancyGridMap2D toOccupancyGrid() const;

  /** Gives a cell of the grid its evidence. */
  void set(int cx, int cy, float log_odds, float hits) {
    const std::size_t index = tableIndex(cx >> kShift, cy >> kShift);
    if (numbers_[index] < 0) store({}, cx >> kShift, cy >> kShift);
    Block& block = cells_[static_cast<std::size_t>(numbers_[index])];
    const std::size_t k = indexInBlock(cx, cy);
    block.log_odds[k] = log_odds;
    block.hits[k] = hits;
  }

  void writeTo(mrpt::serialization::CArchive& out) const;

  /** Throws std::runtime_error if sizes are implausible or do not match. */
  static PackedEvidence readFrom(mrpt::serialization::CArchive& in);

  bool empty() const { return cells_.empty(); }

  /** Cells in the blocks that are stored. */
  std::size_t storedCells() const { return cells_.size() * kSide * kSide; }

  /** Number of cells with hits > 0. */
  std::size_t observedCells() const;

  /** The smallest range that holds every observed cell. */
  CellRange observedRange() const;

  /** Memory it takes. */
  std::size_t bytes() const;

  double resolution() const { return resolution_; }    ///< m per cell
  double xMin() const { return x_min_; }               ///< left edge of cell (0, ·) (m)
  double yMin() const { return y_min_; }               ///< lower edge of cell (·, 0) (m)
  double xMax() const { return x_max_; }               ///< right edge of the last column (m)
  double yMax() const { return y_max_; }               ///< upper edge of the last row (m)
  int sizeX() const { return static_cast<int>(nx_); }  ///< cells
  int sizeY() const { return static_cast<int>(ny_); }  ///< cells

  /** Log-odds sum and hit count of a cell; (0, 0) if it is unknown or outside. */
  std::pair<float, float> cell(int cx, int cy) const {
    const Block* block = blockAt(cx >> kShift, cy >> kShift);
    if (!block) return {0.0f, 0.0f};
    const std::size_t k = indexInBlock(cx, cy);
    return {block->log_odds[k], block->hits[k]};
  }

  /** Calls visit(cx, cy, log_odds, hits) for each observed cell, in a fixed order. */
  template <class Visit>
  void forEachObserved(Visit visit) const {
    for (int by = 0; by < rows_; ++by)
      for (int bx = 0; bx < columns_; ++bx)
        if (const Block* block = blockAt(bx, by))
          for (std::size_t k = 0; k < kSide * kSide; ++k)
            if (block->hits[k] > 0)
              visit((bx << kShift) + static_cast<int>(k % kSide),
                    (by << kShift) + static_cast<int>(k / kSide), block->log_odds[k], block->hits[k]);
  }

  /** Whether any of the four cells (cx, cy) … (cx + 1, cy + 1) may be observed. */
  bool mayReach(int cx, int cy) const {
    const int bx = (cx >> kShift) + 1, by = (cy >> kShift) + 1;
    return bx >= 0 && bx <= columns_ && by >= 0 && by <= rows_ &&
           reach_[static_cast<std::size_t>(by) * static_cast<std::size_t>(columns_ + 1) +
                  static_cast<std::size_t>(bx)] != 0;
  }

 private:
  static constexpr int kShift = 3, kSide = 1 << kShift, kMask = kSide - 1;
  struct Block {
    std::array<float, kSide * kSide> log_odds{}, hits{};  // row by row
  };

  static std::size_t indexInBlock(int cx, int cy) {
    return static_cast<std::size_t>(((cy & kMask) << kShift) + (cx & kMask));
  }
  std::size_t tableIndex(int bx, int by) const {
    return static_cast<std::size_t>(by) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(bx);
  }
  const Block* blockAt(int bx, int by) const {
    if (bx < 0 || bx >= columns_ || by < 0 || by >= rows_) return nullptr;
    const int32_t k = numbers_[tableIndex(bx, by)];
    return k < 0 ? nullptr : &cells_[static_cast<std::size_t>(k)];
  }
  /** No block is stored yet; the limits are those of two grids along the axes. */
  PackedEvidence(const EvidenceLayer& along_x, const EvidenceLayer& along_y);
  PackedEvidence(double x_min, double x_max, double y_min, double y_max, double resolution, std::size_t nx,
                 std::size_t ny);
  void packBlock(const EvidenceGrid& grid, int bx, int by);
  void store(const Block& block, int bx, int by);
  void place(std::size_t number, int bx, int by);
  std::vector<uint32_t> storedPositions() const;

  double x_min_, y_min_, x_max_, y_max_, resolution_;
  std::size_t nx_, ny_;
  int columns_, rows_;            // of blocks
  std::vector<int32_t> numbers_;  // index into cells_ of each block, row by row; -1: unknown
  std::vector<Block> cells_;
  std::vector<uint8_t> reach_;  // mayReach by block, from block (-1, -1), row by row
};

}  // namespace submap_slam
