#pragma once

#include <submap_slam/core/packed_evidence.h>

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

  /** 255 · the best score of the 2^level × 2^level cells from (column, row) up. */
  uint8_t score(int level, int column, int row) const {
    const Level& l = levels_[static_cast<std::size_t>(level)];
    const auto c = static_cast<unsigned>(column + l.margin), r = static_cast<unsigned>(row + l.margin);
    return c < l.columns && r < l.rows ? l.scores[r * l.columns + c] : unknown_;
  }

 private:
  struct Level {
    int margin = 0;  ///< cells before column and row 0
    unsigned columns = 0, rows = 0;
    std::vector<uint8_t> scores;  ///< row by row
  };
  Level finest(const PackedEvidence& evidence) const;
  Level coarser(const Level& fine, int step) const;

  double resolution_, x_min_, y_min_;
  uint8_t unknown_;
  std::vector<Level> levels_;
};

}  // namespace submap_slam
