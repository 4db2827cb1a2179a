#include "tiled_evidence.h"

#include <algorithm>

namespace submap_slam {
namespace {

/** Calls f(x, y, k) for cell k of a square at (x, y). */
template <class F>
void forEachCell(unsigned x0, unsigned y0, unsigned side, F f) {
  std::size_t k = 0;
  for (unsigned y = y0; y < y0 + side; ++y)
    for (unsigned x = x0; x < x0 + side; ++x) f(x, y, k++);
}

}  // namespace

void TiledEvidence::changeTile(unsigned x, unsigned y) {
  auto& tile = tiles_[{y >> kShift, x >> kShift}];
  if (!tile) tile = std::make_unique<Tile>();
  last_ = tile.get();
  last_x_ = x, last_y_ = y;
}

TiledEvidence::Extent TiledEvidence::observed() const {
  Extent extent;
  for (const auto& entry : tiles_)
    forEachCell(entry.first.second * kSide, entry.first.first * kSide, kSide,
                [&](unsigned x, unsigned y, std::size_t k) {
                  if (entry.second->hits[k] <= 0) return;
                  extent.left = std::min(extent.left, x), extent.right = std::max(extent.right, x);
                  extent.low = std::min(extent.low, y), extent.high = std::max(extent.high, y);
                });
  return extent;
}

void TiledEvidence::copy(const Place& place, const Tile& tile, const Extent& from, PackedEvidence& evidence) {
  forEachCell(place.second * kSide, place.first * kSide, kSide, [&](unsigned x, unsigned y, std::size_t k) {
    if (tile.hits[k] <= 0) return;
    evidence.set(static_cast<int>(x - from.left), static_cast<int>(y - from.low), tile.log_odds[k],
                 tile.hits[k]);
  });
}

PackedEvidence TiledEvidence::take(double resolution) {
  last_x_ = last_y_ = ~0u;
  const Extent extent = observed();
  if (extent.empty()) return PackedEvidence(0, resolution, 0, resolution, resolution);
  const auto limit = [resolution](unsigned cell) {
    return resolution * (static_cast<double>(cell) - static_cast<double>(kOrigin));
  };
  PackedEvidence evidence(limit(extent.left), limit(extent.right + 1), limit(extent.low),
                          limit(extent.high + 1), resolution);
  for (auto tile = tiles_.begin(); tile != tiles_.end(); tile = tiles_.erase(tile))
    copy(tile->first, *tile->second, extent, evidence);
  return PackedEvidence(evidence);  // without the room for blocks that nobody saw
}

}  // namespace submap_slam
