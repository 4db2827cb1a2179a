#pragma once

#include <submap_slam/core/joined_map.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace submap_slam::grid_joining {

/** Evidence of one cell. */
struct EvidenceCell {
  float log_odds = 0;  ///< sum of log-odds above the background, positive = occupied
  float hits = 0;      ///< number of observations; 0: unknown
};

/** Bilinear values at a point and their gradients along the submap's axes. */
struct EvidenceSample {
  double log_odds = 0, hits = 0;
  std::array<double, 2> log_odds_gradient{}, hits_gradient{};  ///< per metre
};

/** The observed part of one submap at one resolution as a plain array, with a rim of unknown cells one cell
 * wide. Only an intermediate on the way to an EvidenceLevel. */
struct EvidenceRaster {
  double x0 = 0, y0 = 0;  ///< centre of cell (0, 0), which belongs to the rim, in the local map frame (m)
  double resolution = 1;  ///< m per cell
  int columns = 0, rows = 0;
  std::vector<EvidenceCell> cells;  ///< row by row

  EvidenceRaster() = default;
  EvidenceRaster(double x0, double y0, double resolution, int columns, int rows);

  /** The observed cells; empty if there are none.
   * @param background log-odds per hit that are taken off, see backgroundOf */
  static EvidenceRaster fromEvidence(const PackedEvidence& evidence, double background = 0);

  /** Twice the cell size; each cell is the sum of 2 × 2 cells. */
  EvidenceRaster halved() const;

  /** Gives every observation the same weight: L ← L/√N, N ← √N, so that the joint cost becomes Σ N (m −
   * L/N)². Coarse cells hold so many observations that the plain sums would be ruled by a few of them. */
  void standardise();

  EvidenceCell& cell(int column, int row) { return cells[index(column, row)]; }
  const EvidenceCell& cell(int column, int row) const { return cells[index(column, row)]; }

 private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

/** What an EvidenceLevel stores of a block besides its hits. */
struct StoredBlock {
  uint64_t surface = 0;      ///< EvidenceLevel::Block::surface
  std::size_t log_odds = 0;  ///< index of its first log-odds; 0, of zeros, if it shows no surface
};

/** Blocks of an EvidenceLevel around some block: the one `right` and `up` of it is entry right + stride · up.
 * Hits and log-odds of a block are kStride × kStride values, row by row. */
struct EvidenceBlockTable {
  const int32_t* numbers;  ///< of the blocks; 0, one of unknown cells, where none is stored
  int stride;
  const StoredBlock* blocks;  ///< by their numbers
  const float* hits;          ///< of all blocks by their numbers
  const float* log_odds;
};

/** The evidence of one submap at one resolution. Only blocks of 8 × 8 cells with something observed are
 * stored, and log-odds only of those that show a surface: a submap fills a tenth of its bounding box, and
 * most of that is free space. Index coordinates (cell centres are integers) count from the raster's cell
 * (0, 0); everything outside the raster is unknown, so the interpolated fields are continuous everywhere. */
class EvidenceLevel {
 public:
  static constexpr int kBlockShift = 3, kBlock = 1 << kBlockShift;

  /** A block is stored with the first row and column of the next ones: every look-up needs one block only. */
  static constexpr int kStride = kBlock + 1, kStored = kStride * kStride;

  /** Blocks around the raster that may be looked up without asking. */
  static constexpr int kMargin = 5;

  EvidenceLevel() = default;
  explicit EvidenceLevel(const EvidenceRaster& raster);

  bool empty() const { return blocks_.empty(); }
  double resolution() const { return resolution_; }  ///< m per cell

  double columnOf(double x) const { return (x - x0_) / resolution_; }
  double rowOf(double y) const { return (y - y0_) / resolution_; }

  /** Local map frame coordinates (m) of index coordinates. */
  double xOf(double column) const { return x0_ + column * resolution_; }
  double yOf(double row) const { return y0_ + row * resolution_; }

  /** Bilinear interpolation anywhere. */
  EvidenceSample sample(double column, double row) const;
  double hitsAt(double column, double row) const;  ///< EvidenceSample::hits

  /** A stored block: look-ups (c + a, r + b), 0 ≤ a, b < 1, with (c, r) in it may see something. */
  struct Block {
    int column = 0, row = 0;  ///< its first cell
    uint64_t surface = 0;     ///< bit 8·r + c: a look-up there sees log-odds above the background
  };
  const std::vector<Block>& blocks() const { return blocks_; }

  /** Where the blocks are, counted from the one with the given cell, for look-ups at speed. Cells may lie
   * kMargin blocks outside the raster. */
  EvidenceBlockTable tableAt(int column, int row) const;

 private:
  void addBlock(const EvidenceRaster& raster, int block_column, int block_row);
  bool tableHolds(double column, double row) const;
  std::size_t tableIndex(int column, int row) const {
    return static_cast<std::size_t>((row >> kBlockShift) + kMargin) * table_columns_ +
           static_cast<std::size_t>((column >> kBlockShift) + kMargin);
  }

  double x0_ = 0, y0_ = 0, resolution_ = 1;
  std::size_t table_columns_ = 0, table_rows_ = 0;
  std::vector<int32_t> numbers_;  // row by row
  std::vector<Block> blocks_;
  std::vector<StoredBlock> stored_;     // by number, the first one unknown
  std::vector<float> hits_, log_odds_;  // block by block, the first one unknown
};

/** All submaps at one resolution, in the order of the submaps. */
using EvidenceLevels = std::vector<EvidenceLevel>;

/** The least log-odds per hit of any cell: that of free space, where nothing but free evidence was seen. Cost
 * and normal equations do not change when it is taken off everywhere, L ← L − background · N (the paper's
 * Jacobian excepted); then free space is exactly zero and only cells near surfaces need work. */
double backgroundOf(const GridSubmaps& submaps);

/** How often the cells of each submap must be joined 2 × 2 to become as large as those of the coarsest one.
 * Submaps without evidence count for nothing. Throws InputError where no power of two leads there. */
std::vector<int> halvingsToCoarsest(const GridSubmaps& submaps);

struct PyramidShape {
  int finest_level = 0;  ///< levels finer than that are not kept
  int levels = 1;
  double background = 0;  ///< see backgroundOf
};

/** Levels finest_level … finest_level + levels − 1 of all submaps, finest first; level k has cells of 2ᵏ
 * times the size of the coarsest submap's. Throws as halvingsToCoarsest. The finest one keeps the plain sums
 * of the paper's objective, the coarser ones are standardised. */
std::vector<EvidenceLevels> buildPyramid(const GridSubmaps& submaps, const PyramidShape& shape);

}  // namespace submap_slam::grid_joining
