#include <submap_slam/matching/score_pyramid.h>

#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

constexpr uint8_t kFree = 0, kOccupied = 255;

}  // namespace

ScorePyramid::ScorePyramid(const PackedEvidence& evidence, const ScorePyramidParams& params)
    : resolution_(std::max(params.resolution, evidence.resolution())),
      x_min_(evidence.xMin()),
      y_min_(evidence.yMin()),
      unknown_(static_cast<uint8_t>(std::lround(255 * params.unknown_score))) {
  levels_.push_back(finest(evidence));
  for (int level = 1; level < params.levels; ++level)
    levels_.push_back(coarser(levels_.back(), 1 << (level - 1)));
}

ScorePyramid::Level ScorePyramid::finest(const PackedEvidence& evidence) const {
  const double scale = evidence.resolution() / resolution_;
  const auto cells = [scale](int n) { return static_cast<unsigned>(std::ceil(n * scale)) + 1; };
  Level level{0, cells(evidence.sizeX()), cells(evidence.sizeY()), {}};
  level.scores.assign(std::size_t{level.columns} * level.rows, unknown_);
  for (int cy = 0; cy < evidence.sizeY(); ++cy)
    for (int cx = 0; cx < evidence.sizeX(); ++cx) {
      const auto [log_odds, hits] = evidence.cell(cx, cy);
      if (hits <= 0) continue;
      const auto column = static_cast<std::size_t>((cx + 0.5) * scale);
      const auto row = static_cast<std::size_t>((cy + 0.5) * scale);
      uint8_t& score = level.scores[row * level.columns + column];
      // One occupied cell makes the coarse one occupied, one free cell makes an unknown one free.
      if (log_odds > 0) {
        score = kOccupied;
      } else if (score != kOccupied) {
        score = kFree;
      }
    }
  return level;
}

ScorePyramid::Level ScorePyramid::coarser(const Level& fine, int step) const {
  const auto added = static_cast<unsigned>(step);
  Level level{fine.margin + step, fine.columns + added, fine.rows + added, {}};
  level.scores.resize(std::size_t{level.columns} * level.rows);
  const auto at = [&](unsigned column, unsigned row) {   // of the fine level, where this one's cell begins
    const unsigned c = column - added, r = row - added;  // wraps around before the first
    return c < fine.columns && r < fine.rows ? fine.scores[std::size_t{r} * fine.columns + c] : unknown_;
  };
  for (unsigned row = 0; row < level.rows; ++row)
    for (unsigned column = 0; column < level.columns; ++column)
      level.scores[std::size_t{row} * level.columns + column] =
          std::max(std::max(at(column, row), at(column + added, row)),
                   std::max(at(column, row + added), at(column + added, row + added)));
  return level;
}

}  // namespace submap_slam
