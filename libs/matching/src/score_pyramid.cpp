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
  Layer layer = finest(evidence);
  levels_.push_back(withNeighbours(layer, 1));
  for (int level = 1; level < params.levels; ++level) {
    const int half = 1 << (level - 1);
    layer = coarser(layer, half);
    levels_.push_back(withNeighbours(layer, level == 1 ? 2 : half));
  }
}

ScorePyramid::Layer ScorePyramid::unknownLayer(int margin, unsigned columns, unsigned rows) const {
  return {margin, columns, rows, std::vector<uint8_t>(std::size_t{columns} * rows, unknown_)};
}

ScorePyramid::Layer ScorePyramid::finest(const PackedEvidence& evidence) const {
  const double scale = evidence.resolution() / resolution_;
  const auto cells = [scale](int n) { return static_cast<unsigned>(std::ceil(n * scale)) + 1; };
  Layer layer = unknownLayer(0, cells(evidence.sizeX()), cells(evidence.sizeY()));
  evidence.forEachObserved([&](int cx, int cy, float log_odds, float) {
    const auto column = static_cast<std::size_t>((cx + 0.5) * scale);
    const auto row = static_cast<std::size_t>((cy + 0.5) * scale);
    uint8_t& score = layer.scores[row * layer.columns + column];
    // One occupied cell makes the coarse one occupied, one free cell makes an unknown one free.
    if (log_odds > 0) {
      score = kOccupied;
    } else if (score != kOccupied) {
      score = kFree;
    }
  });
  return layer;
}

uint8_t ScorePyramid::scoreIn(const Layer& layer, int column, int row) const {
  const auto x = static_cast<unsigned>(column + layer.margin), y = static_cast<unsigned>(row + layer.margin);
  if (x >= layer.columns || y >= layer.rows) return unknown_;  // what lies before the first wraps around
  return layer.scores[std::size_t{y} * layer.columns + x];
}

ScorePyramid::Layer ScorePyramid::coarser(const Layer& fine, int step) const {
  const auto added = static_cast<unsigned>(step);
  Layer layer = unknownLayer(fine.margin + step, fine.columns + added, fine.rows + added);
  std::size_t k = 0;
  for (int row = -layer.margin; row < static_cast<int>(layer.rows) - layer.margin; ++row)
    for (int column = -layer.margin; column < static_cast<int>(layer.columns) - layer.margin; ++column)
      layer.scores[k++] =
          std::max({scoreIn(fine, column, row), scoreIn(fine, column + step, row),
                    scoreIn(fine, column, row + step), scoreIn(fine, column + step, row + step)});
  return layer;
}

ScorePyramid::Level ScorePyramid::withNeighbours(const Layer& layer, int step) const {
  const auto added = static_cast<unsigned>(step);
  Level level{step, layer.margin + step, layer.columns + added, layer.rows + added, {}};
  level.fours.reserve((std::size_t{level.columns} + 1) * (std::size_t{level.rows} + 1));
  for (int row = -level.margin; row <= static_cast<int>(level.rows) - level.margin; ++row)
    for (int column = -level.margin; column <= static_cast<int>(level.columns) - level.margin; ++column) {
      const auto at = [&](int dx, int dy) { return uint32_t{scoreIn(layer, column + dx, row + dy)}; };
      level.fours.push_back(at(0, 0) | at(step, 0) << 8 | at(0, step) << 16 | at(step, step) << 24);
    }
  return level;
}

}  // namespace submap_slam
