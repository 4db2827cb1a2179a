#include "lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace submap_slam::grid_joining {
namespace {

/** A submap's claim to a tile. */
struct Claim {
  int b, a;
  std::size_t submap;
  bool surface;
};

int tileOf(double coordinate) { return static_cast<int>(std::floor(coordinate / kTile)); }

/** Adds a claim for each tile that the submap touches. */
void claimTiles(const PlacedLevel& placed, std::size_t submap, std::vector<Claim>& claims) {
  const std::size_t first = claims.size();
  const double half = 0.5 * EvidenceLevel::kBlock, reach = placed.blockReach();
  for (const EvidenceLevel::Block& block : placed.level().blocks()) {
    const double a = placed.aOf(block.column + half, block.row + half);
    const double b = placed.bOf(block.column + half, block.row + half);
    for (int tb = tileOf(b - reach); tb <= tileOf(b + reach); ++tb)
      for (int ta = tileOf(a - reach); ta <= tileOf(a + reach); ++ta)
        claims.push_back({tb, ta, submap, block.surface != 0});
  }
  // Several blocks claim the same tile: one claim is left, of surfaces if there is any.
  const auto begin = claims.begin() + static_cast<std::ptrdiff_t>(first);
  std::sort(begin, claims.end(), [](const Claim& x, const Claim& y) {
    return std::tie(x.b, x.a, y.surface) < std::tie(y.b, y.a, x.surface);
  });
  claims.erase(std::unique(begin, claims.end(),
                           [](const Claim& x, const Claim& y) { return x.b == y.b && x.a == y.a; }),
               claims.end());
}

std::vector<Tile> overlapTiles(const std::vector<PlacedLevel>& placed) {
  std::vector<Claim> claims;
  for (std::size_t i = 0; i < placed.size(); ++i) claimTiles(placed[i], i, claims);
  std::sort(claims.begin(), claims.end(), [](const Claim& x, const Claim& y) {
    return std::tie(x.b, x.a, x.submap) < std::tie(y.b, y.a, y.submap);
  });
  std::vector<Tile> tiles;
  for (std::size_t first = 0, next = 0; first < claims.size(); first = next) {
    const Claim& tile = claims[first];
    while (next < claims.size() && claims[next].a == tile.a && claims[next].b == tile.b) ++next;
    if (next - first < 2) continue;
    tiles.push_back({tile.a * kTile, tile.b * kTile, {}});
    for (std::size_t k = first; k < next; ++k)
      tiles.back().members.push_back({claims[k].submap, claims[k].surface});
  }
  return tiles;
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

bool Tile::hasSurface() const {
  return std::any_of(members.begin(), members.end(), [](const TileMember& m) { return m.surface; });
}

PlacedLevels::PlacedLevels(const EvidenceLevels& levels, const Frames& frames, double lattice_angle) {
  submaps.reserve(levels.size());
  for (std::size_t i = 0; i < levels.size(); ++i) submaps.emplace_back(levels[i], frames[i], lattice_angle);
  tiles = overlapTiles(submaps);
}

}  // namespace submap_slam::grid_joining
