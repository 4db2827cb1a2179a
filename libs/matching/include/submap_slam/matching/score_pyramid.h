#pragma once

#include <submap_slam/core/packed_evidence.h>

#include <algorithm>
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

  /** One level. Each entry holds the scores of four cells, one in each byte, because a search that halves a
   * square asks for them together: from the lowest byte on those of (column, row), (column + step, row),
   * (column, row + step) and (column + step, row + step). */
  struct Level {
    int step = 1;    ///< cells of the finest level
    int margin = 0;  ///< cells before column and row 0
    unsigned columns = 0, rows = 0;
    std::vector<uint32_t> fours;  ///< row by row; with one more column and one more row, which are unknown

    /** 255 · the best score of the cells from (column, row) up, of any size. */
    uint8_t score(int column, int row) const {
      return static_cast<uint8_t>(
          fours[indexOf(row, rows) * (std::size_t{columns} + 1) + indexOf(column, columns)]);
    }

   private:
    std::size_t indexOf(int place, unsigned count) const {  // what lies before the first wraps around
      return std::min(static_cast<unsigned>(place + margin), count);
    }
  };
  const Level& level(int level) const { return levels_[static_cast<std::size_t>(level)]; }
  uint8_t score(int level, int column, int row) const { return this->level(level).score(column, row); }

 private:
  /** Scores of a level, one by one. */
  struct Layer {
    int margin = 0;
    unsigned columns = 0, rows = 0;
    std::vector<uint8_t> scores;  // row by row
  };
  Layer unknownLayer(int margin, unsigned columns, unsigned rows) const;
  Layer finest(const PackedEvidence& evidence) const;
  Layer coarser(const Layer& fine, int step) const;
  Level withNeighbours(const Layer& layer, int step) const;
  uint8_t scoreIn(const Layer& layer, int column, int row) const;

  double resolution_, x_min_, y_min_;
  uint8_t unknown_;
  std::vector<Level> levels_;
};

}  // namespace submap_slam
