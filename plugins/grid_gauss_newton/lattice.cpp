#include "lattice.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace submap_slam::grid_joining {
namespace {

int tileOf(double coordinate) { return static_cast<int>(std::floor(coordinate / kTile)); }

/** A submap's claim to a tile as one number, so that sorting brings the claims to a tile together, row by row
 * and in the order of the submaps. */
using Claim = uint64_t;
constexpr int kTileBits = 21, kSubmapBits = 21;
constexpr int kTileOffset = 1 << (kTileBits - 1);

Claim makeClaim(int a, int b, std::size_t submap, bool surface) {
  const auto bits = [](int tile) { return static_cast<Claim>(tile + kTileOffset); };
  return (((bits(b) << kTileBits | bits(a)) << kSubmapBits | submap) << 1) | (surface ? 1 : 0);
}
Claim tileOf(Claim claim) { return claim >> (kSubmapBits + 1); }

/** The tiles that the blocks of a submap may touch. */
class TouchedTiles {
 public:
  explicit TouchedTiles(const PlacedLevel& placed);
  void addClaims(std::size_t submap, std::vector<Claim>& claims) const;

 private:
  int a_ = 0, b_ = 0, width_ = 0, height_ = 0;
  std::vector<uint8_t> touched_;  // 1: by a block, 2 or 3: by one with surfaces
};

TouchedTiles::TouchedTiles(const PlacedLevel& placed) {
  const auto& blocks = placed.level().blocks();
  if (blocks.empty()) return;
  const double half = 0.5 * EvidenceLevel::kBlock, reach = placed.blockReach();
  int left = blocks.front().column, right = left, bottom = blocks.front().row, top = bottom;
  for (const EvidenceLevel::Block& block : blocks) {
    left = std::min(left, block.column), right = std::max(right, block.column);
    bottom = std::min(bottom, block.row), top = std::max(top, block.row);
  }
  double a_min = std::numeric_limits<double>::infinity(), a_max = -a_min, b_min = a_min, b_max = -a_min;
  for (const double column : {left + half, right + half})
    for (const double row : {bottom + half, top + half}) {
      const double a = placed.aOf(column, row), b = placed.bOf(column, row);
      a_min = std::min(a_min, a), a_max = std::max(a_max, a), b_min = std::min(b_min, b),
      b_max = std::max(b_max, b);
    }
  a_ = tileOf(a_min - reach) - 1, b_ = tileOf(b_min - reach) - 1;  // a rim for rounding
  width_ = tileOf(a_max + reach) + 2 - a_, height_ = tileOf(b_max + reach) + 2 - b_;
  touched_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
  for (const EvidenceLevel::Block& block : blocks) {
    const double a = placed.aOf(block.column + half, block.row + half);
    const double b = placed.bOf(block.column + half, block.row + half);
    const int a_first = tileOf(a - reach), a_last = tileOf(a + reach), b_last = tileOf(b + reach);
    for (int tb = tileOf(b - reach); tb <= b_last; ++tb)
      for (int ta = a_first; ta <= a_last; ++ta)
        touched_[static_cast<std::size_t>((tb - b_) * width_ + ta - a_)] |= block.surface != 0 ? 3 : 1;
  }
}

void TouchedTiles::addClaims(std::size_t submap, std::vector<Claim>& claims) const {
  auto touched = touched_.begin();
  for (int b = b_; b < b_ + height_; ++b)
    for (int a = a_; a < a_ + width_; ++a, ++touched)
      if (*touched) claims.push_back(makeClaim(a, b, submap, *touched > 1));
}

}  // namespace

PlacedLevel::PlacedLevel(const EvidenceLevel& level, const mrpt::math::TPose2D& T_w_s, double lattice_angle)
    : level_(&level), cos_(std::cos(T_w_s.phi - lattice_angle)), sin_(std::sin(T_w_s.phi - lattice_angle)) {
  const double c = std::cos(T_w_s.phi), s = std::sin(T_w_s.phi);
  column0_ = level.columnOf(-c * T_w_s.x - s * T_w_s.y);
  row0_ = level.rowOf(s * T_w_s.x - c * T_w_s.y);
}

double PlacedLevel::blockReach() const {
  return 0.5 * EvidenceLevel::kBlock * (std::abs(cos_) + std::abs(sin_));
}

PlacedLevels::PlacedLevels(const EvidenceLevels& levels, const Frames& frames, double lattice_angle) {
  submaps.reserve(levels.size());
  std::vector<Claim> claims;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    submaps.emplace_back(levels[i], frames[i], lattice_angle);
    TouchedTiles(submaps.back()).addClaims(i, claims);
  }
  tbb::parallel_sort(claims.begin(), claims.end());
  constexpr Claim kTileMask = (Claim{1} << kTileBits) - 1, kSubmapMask = (Claim{1} << kSubmapBits) - 1;
  for (std::size_t first = 0, next = 0; first < claims.size(); first = next) {
    const Claim tile = tileOf(claims[first]);
    while (next < claims.size() && tileOf(claims[next]) == tile) ++next;
    if (next - first < 2) continue;
    const auto lattice = [](Claim bits) {
      return (static_cast<int>(bits & kTileMask) - kTileOffset) * kTile;
    };
    tiles.push_back({lattice(tile), lattice(tile >> kTileBits), members.size(), next - first, false});
    for (std::size_t k = first; k < next; ++k) {
      members.push_back({claims[k] >> 1 & kSubmapMask, (claims[k] & 1) != 0});
      tiles.back().surface |= members.back().surface;
    }
  }
}

}  // namespace submap_slam::grid_joining
