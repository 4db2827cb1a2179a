#pragma once

#include <submap_slam/core/packed_evidence.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace submap_slam {

struct ScorePyramidParams {
  double resolution = 0.4;  ///< m per cell of the finest level, at least that of the evidence
  int levels = 8;
  double unknown_score = 0.27;  ///< of a cell that was not observed; free 0, occupied 1
};

/** What a point scores that falls on a cell of a submap, and upper bounds of it: a cell of level h holds the
 * best score of the 2ʰ × 2ʰ cells of the finest level from it upwards (Hess et al., "Real-Time Loop Closure
 * in 2D LIDAR SLAM", ICRA 2016, eq. 14–17).
 *
 * Frame: local map frame. Cells have integer coordinates which may lie anywhere; far outside of the submap
 * everything is unknown.
 */
class ScorePyramid {
 public:
  ScorePyramid(const PackedEvidence& evidence, const ScorePyramidParams& params);

  int levels() const { return static_cast<int>(levels_.size()); }
  double resolution() const { return resolution_; }

  /** Cell coordinates (finest level) of a point of the local map frame (m), before rounding down. */
  double column(double x) const { return (x - x_min_) / resolution_; }
  double row(double y) const { return (y - y_min_) / resolution_; }

  /** One level. */
  struct Level {
    int margin = 0;  ///< cells before column and row 0
    unsigned columns = 0, rows = 0;
    std::vector<uint8_t> scores;  ///< row by row; with one more column and one more row, which are unknown

    /** 255 · the best score of the 2^level × 2^level cells from (column, row) up. */
    uint8_t score(int column, int row) const { return scores[rowOffset(row) + columnOffset(column)]; }

    /** Those of (column, row), (column + step, row), (column, row + step) and (column + step, row + step). */
    std::array<uint8_t, 4> fourScores(int column, int row, int step) const {
      const std::size_t left = columnOffset(column), right = columnOffset(column + step);
      const uint8_t *low = &scores[rowOffset(row)], *high = &scores[rowOffset(row + step)];
      return {low[left], low[right], high[left], high[right]};
    }

   private:
    friend class ScorePyramid;
    std::size_t stride() const { return std::size_t{columns} + 1; }
    std::size_t columnOffset(int column) const {  // what lies before the first wraps around
      return std::min(static_cast<unsigned>(column + margin), columns);
    }
    std::size_t rowOffset(int row) const {
      return std::min(static_cast<unsigned>(row + margin), rows) * stride();
    }
  };
  const Level& level(int level) const { return levels_[static_cast<std::size_t>(level)]; }
  uint8_t score(int level, int column, int row) const { return this->level(level).score(column, row); }

 private:
  Level finest(const PackedEvidence& evidence) const;
  Level coarser(const Level& fine, int step) const;
  Level unknownLevel(int margin, unsigned columns, unsigned rows) const;

  double resolution_, x_min_, y_min_;
  uint8_t unknown_;
  std::vector<Level> levels_;
};

}  // namespace submap_slam
