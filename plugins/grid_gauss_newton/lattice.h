#pragma once

#include <cstddef>
#include <vector>

#include "pose_system.h"
#include "pyramid.h"

namespace submap_slam::grid_joining {

/** Side of the square tiles in which the global lattice is walked. */
constexpr int kTile = 16;

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

  /** What the index coordinates grow by with a: (column, row); with b it is (−row, column). */
  double columnStep() const { return cos_; }
  double rowStep() const { return -sin_; }

  /** Lattice coordinates of index coordinates. */
  double aOf(double column, double row) const { return cos_ * (column - column0_) - sin_ * (row - row0_); }
  double bOf(double column, double row) const { return sin_ * (column - column0_) + cos_ * (row - row0_); }

  /** Largest distance along a or b from the centre of a block of cells to a look-up in it, in lattice steps.
   */
  double blockReach() const;

 private:
  const EvidenceLevel* level_;
  double cos_, sin_;  // of the heading in the lattice's frame
  double column0_, row0_;
};

/** A submap that may be seen in a tile. */
struct TileMember {
  std::size_t submap = 0;
  bool surface = false;  ///< it may show surfaces there; without any the tile adds nothing to the cost
};

/** A tile of the lattice that two or more submaps touch. */
struct Tile {
  int a = 0, b = 0;          ///< its first lattice point
  std::size_t first_member;  ///< in PlacedLevels::members
  std::size_t members;       ///< how many
  bool surface;              ///< any of them may show surfaces
};

/** All submaps at one resolution, placed, and where they may overlap. */
struct PlacedLevels {
  PlacedLevels(const EvidenceLevels& levels, const Frames& frames, double lattice_angle);

  std::vector<PlacedLevel> submaps;  ///< in the order given
  std::vector<Tile> tiles;           ///< row by row
  std::vector<TileMember> members;   ///< of all tiles, in ascending order for each tile
};

}  // namespace submap_slam::grid_joining
