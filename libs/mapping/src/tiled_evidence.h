#pragma once

#include <submap_slam/core/packed_evidence.h>

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <utility>

namespace submap_slam {

/** Evidence in square tiles, which are made where something is drawn: its extent need not be known before,
 * and what nobody saw takes no memory. Cell (0, 0) has its corner at the origin. */
class TiledEvidence {
 public:
  void add(int column, int row, float log_odds, float hits) {
    const unsigned x = static_cast<unsigned>(column + kOrigin), y = static_cast<unsigned>(row + kOrigin);
    if (((x ^ last_x_) | (y ^ last_y_)) > kMask) changeTile(x, y);
    const std::size_t cell = ((y & kMask) << kShift) + (x & kMask);
    last_->log_odds[cell] += log_odds;
    last_->hits[cell] += hits;
  }

  /** Gives all up for the smallest grid that holds every observed cell; one unknown cell if there is none. */
  PackedEvidence take(double resolution);

 private:
  static constexpr unsigned kShift = 6, kSide = 1u << kShift, kMask = kSide - 1;
  static constexpr int kOrigin = 1 << 30;       ///< of the indices, which are positive
  using Place = std::pair<unsigned, unsigned>;  ///< row and column of a tile
  struct Tile {
    std::array<float, kSide * kSide> log_odds{}, hits{};
  };
  /** First and last column and row that hold an observed cell. */
  struct Extent {
    unsigned left = ~0u, right = 0, low = ~0u, high = 0;
    bool empty() const { return left > right; }
  };

  void changeTile(unsigned x, unsigned y);
  Extent observed() const;
  static void copy(const Place& place, const Tile& tile, const Extent& from, PackedEvidence& evidence);

  std::map<Place, std::unique_ptr<Tile>> tiles_;
  Tile* last_ = nullptr;                  ///< beams stay in a tile for many cells
  unsigned last_x_ = ~0u, last_y_ = ~0u;  ///< a cell in it
};

}  // namespace submap_slam
