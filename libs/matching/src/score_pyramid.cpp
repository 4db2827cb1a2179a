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

ScorePyramid::Level ScorePyramid::unknownLevel(int margin, unsigned columns, unsigned rows) const {
  Level level{margin, columns, rows, {}};
  level.scores.assign(level.stride() * (std::size_t{rows} + 1), unknown_);
  return level;
}

ScorePyramid::Level ScorePyramid::finest(const PackedEvidence& evidence) const {
  const double scale = evidence.resolution() / resolution_;
  const auto cells = [scale](int n) { return static_cast<unsigned>(std::ceil(n * scale)) + 1; };
  Level level = unknownLevel(0, cells(evidence.sizeX()), cells(evidence.sizeY()));
  evidence.forEachObserved([&](int cx, int cy, float log_odds, float) {
    const auto column = static_cast<std::size_t>((cx + 0.5) * scale);
    const auto row = static_cast<std::size_t>((cy + 0.5) * scale);
    uint8_t& score = level.scores[row * level.stride() + column];
    // One occupied cell makes the coarse one occupied, one free cell makes an unknown one free.
    if (log_odds > 0) {
      score = kOccupied;
    } else if (score != kOccupied) {
      score = kFree;
    }
  });
  return level;
}

ScorePyramid::Level ScorePyramid::coarser(const Level& fine, int step) const {
  const auto added = static_cast<unsigned>(step);
  Level level = unknownLevel(fine.margin + step, fine.columns + added, fine.rows + added);
  for (unsigned y = 0; y < level.rows; ++y)
    for (unsigned x = 0; x < level.columns; ++x) {
      const auto four =
          fine.fourScores(static_cast<int>(x) - level.margin, static_cast<int>(y) - level.margin, step);
      level.scores[y * level.stride() + x] = *std::max_element(four.begin(), four.end());
    }
  return level;
}

}  // namespace submap_slam
