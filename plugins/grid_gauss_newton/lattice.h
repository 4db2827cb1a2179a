#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "pose_system.h"
#include "pyramid.h"

namespace submap_slam::grid_joining {

/** Size of the tiles the global lattice is walked in; a row of a tile is what is sampled at once. */
constexpr int kTileColumns = 64, kTileRows = 16;

/** One level of a submap placed on the global lattice. Lattice point (a, b) lies at Rot(lattice_angle) ·
 * s·(a, b) in the global map frame, s = cell size of the level. A lattice parallel to walls would make the
 * result depend on its phase. */
class PlacedLevel {
 public:
  PlacedLevel(const EvidenceLevel& level, const mrpt::math::TPose2D& T_w_s, double lattice_angle);

  const EvidenceLevel& level() const { return *level_; }

  /** Index coordinates of lattice point (a, b) in the level. */
  double columnOf(int a, int b) const { return column0_ + cos_ * a + sin_ * b; }
  double rowOf(int a, int b) const { return row0_ - sin_ * a + cos_ * b; }
  bool contains(int a, int b) const { return level_->contains(columnOf(a, b), rowOf(a, b)); }

  /** Those a in [a_begin, a_end) for which (a, b) lies in the level, as a half-open interval. */
  std::pair<int, int> clip(int a_begin, int a_end, int b) const;

  /** Half-open bounds on the lattice: a_min, a_max, b_min, b_max. */
  struct Bounds {
    int a_min = 0, a_max = 0, b_min = 0, b_max = 0;
  };
  Bounds bounds() const;

  /** Whether any lattice point of [a, a + kTileColumns) × [b, b + kTileRows) may lie in the level. */
  bool touchesTile(int a, int b) const;

 private:
  const EvidenceLevel* level_;
  double cos_, sin_;  // of the heading in the lattice's frame
  double column0_, row0_;
};

/** Place every non-empty level; the order is that of the submaps, empty ones keep their place. */
std::vector<PlacedLevel> placeAll(const EvidenceLevels& level, const Frames& frames, double lattice_angle);

/** A tile of the lattice and the submaps that may be seen in it, in ascending order. */
struct Tile {
  int a = 0, b = 0;  ///< its first lattice point
  std::vector<std::size_t> submaps;
};

/** All tiles that two or more submaps touch, row by row. */
std::vector<Tile> overlapTiles(const std::vector<PlacedLevel>& placed);

}  // namespace submap_slam::grid_joining
