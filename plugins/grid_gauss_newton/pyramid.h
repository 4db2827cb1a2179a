#pragma once

#include <submap_slam/core/joined_map.h>

#include <array>
#include <cmath>
#include <vector>

namespace submap_slam::grid_joining {

/** Evidence of one cell, both values next to each other because every look-up needs both. */
struct EvidenceCell {
  float log_odds = 0;  ///< sum of log-odds, positive = occupied
  float hits = 0;      ///< number of observations; 0: unknown
};

/** Bilinear values at a point and their gradients along the submap's axes. */
struct EvidenceSample {
  double log_odds = 0, hits = 0;
  std::array<double, 2> log_odds_gradient{}, hits_gradient{};  ///< per metre
};

/** The observed part of one submap at one resolution, with a rim of unknown cells one cell wide, so that the
 * interpolated fields are continuous everywhere and need no bounds check inside [0, columns − 1) × [0, rows −
 * 1). */
class EvidenceLevel {
 public:
  /** Crops the grid to its observed cells; the level is empty if there are none. */
  static EvidenceLevel fromGrid(const EvidenceGrid& grid);

  /** Twice the cell size; each cell is the sum of 2 × 2 cells. */
  EvidenceLevel halved() const;

  /** Gives every observation the same weight: L ← L/√N, N ← √N, so that the joint cost becomes Σ N (m −
   * L/N)². Coarse cells hold so many observations that the plain sums would be ruled by a few of them. */
  void standardise();

  bool empty() const { return cells_.empty(); }
  double resolution() const { return resolution_; }  ///< m per cell
  int columns() const { return columns_; }
  int rows() const { return rows_; }

  /** Index coordinates (cell centres are integers) of a point in the local map frame (m). */
  double columnOf(double x) const { return (x - x0_) / resolution_; }
  double rowOf(double y) const { return (y - y0_) / resolution_; }

  /** Local map frame coordinates (m) of index coordinates. */
  double xOf(double column) const { return x0_ + column * resolution_; }
  double yOf(double row) const { return y0_ + row * resolution_; }

  const EvidenceCell& cell(int column, int row) const { return cells_[index(column, row)]; }

  bool contains(double column, double row) const {
    return column >= 0 && row >= 0 && column < columns_ - 1 && row < rows_ - 1;
  }

  /** Bilinear interpolation; (column, row) must be contained. */
  EvidenceSample sample(double column, double row) const {
    const int c = static_cast<int>(column), r = static_cast<int>(row);
    const double a = column - c, b = row - r, scale = 1 / resolution_;
    const EvidenceCell *low = &cell(c, r), *high = low + columns_;
    EvidenceSample s;
    interpolate({low[0].log_odds, low[1].log_odds, high[0].log_odds, high[1].log_odds}, a, b, scale,
                s.log_odds, s.log_odds_gradient);
    interpolate({low[0].hits, low[1].hits, high[0].hits, high[1].hits}, a, b, scale, s.hits, s.hits_gradient);
    return s;
  }

 private:
  static void interpolate(const std::array<double, 4>& corner, double a, double b, double scale,
                          double& value, std::array<double, 2>& gradient) {
    const double lower = corner[1] - corner[0], upper = corner[3] - corner[2];
    const double bottom = corner[0] + a * lower, top = corner[2] + a * upper;
    value = bottom + b * (top - bottom);
    gradient = {scale * (lower + b * (upper - lower)), scale * (top - bottom)};
  }

  EvidenceLevel() = default;
  EvidenceLevel(double x0, double y0, double resolution, int columns, int rows);
  EvidenceCell& mutableCell(int column, int row) { return cells_[index(column, row)]; }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  double x0_ = 0, y0_ = 0;  // centre of cell (0, 0), which belongs to the rim, in the local map frame (m)
  double resolution_ = 1;
  int columns_ = 0, rows_ = 0;
  std::vector<EvidenceCell> cells_;  // row by row
};

/** All submaps at one resolution, in the order of the submaps. */
using EvidenceLevels = std::vector<EvidenceLevel>;

/** Levels finest_level … finest_level + levels − 1 of all submaps, finest first; level k has cells of 2ᵏ
 * times the submaps' size. The finest one keeps the plain sums of the paper's objective, the coarser ones are
 * standardised. Levels finer than `finest_level` are not kept. */
std::vector<EvidenceLevels> buildPyramid(const GridSubmaps& submaps, int finest_level, int levels);

}  // namespace submap_slam::grid_joining
