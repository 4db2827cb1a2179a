/** Flat worlds of straight walls, in which a laser scanner can be simulated. */
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <string>
#include <vector>

namespace submap_slam {

/** A piece of wall between two points (m, world frame), without thickness. */
struct Wall {
  mrpt::math::TPoint2D a, b;
};

/** Corners of a route through a world (m, world frame). */
using WayPoints = std::vector<mrpt::math::TPoint2D>;

/** Walls, and a route through them that keeps clear of all. */
struct World {
  std::string name;
  std::vector<Wall> walls;
  WayPoints route;

  /** Distance (m) from `origin` to the nearest wall in the direction `angle` (rad, world frame); infinity if
   * there is none. Exact up to rounding. Walls are opaque from both sides; end points belong to the wall; a
   * wall seen exactly edge-on is not hit. */
  double raycast(const mrpt::math::TPoint2D& origin, double angle) const;

  /** Distance (m) to the nearest point of any wall; infinity if there are no walls. */
  double clearance(const mrpt::math::TPoint2D& point) const;
};

/** An office floor of 20 × 15 m: rooms of different size with doors, furniture and columns. The route visits
 * every room and returns to its start. */
World roomWorld();

/** A closed corridor of 40 × 2.5 m with few shallow door niches at irregular places. The route goes to the
 * far end and back. */
World corridorWorld();

/** A closed corridor of 40 × 2.5 m with identical niches every 2.5 m on both sides; only one end is
 * distinctive. A laser that sees no end cannot tell the niches apart. The route goes from the plain end to
 * the distinctive one and back. */
World periodicCorridorWorld();

/** A corridor with a row of eight identical rooms, one of which (the sixth) holds a pillar at its back wall.
 * The route looks into the second room and the sixth. */
World symmetricRoomsWorld();

/** A square ring of corridors of 25 × 25 m around a block, with rooms on the outside. The route goes 1.3
 * times around. */
World loopWorld();

/** A hall of 50 × 50 m with obstacles that are not convex: hooks, bays, tees and stars at odd angles. The
 * route winds between them and returns to its start. */
World nonConvexWorld();

/** Corridors of 3 m width around and through a square of 50 × 50 m, with few shallow niches. The
 * route goes around one block and some way on. */
World longCorridorsWorld();

/** An office floor of 30 × 100 m: two long corridors with offices on the outside, joined by four cross
 * corridors. The route closes three loops and returns to its start. */
World officeFloorWorld();

/** Names that makeWorld() knows: room, corridor, periodic_corridor, symmetric_rooms, loop, non_convex,
 * long_corridors, floor. */
std::vector<std::string> worldNames();

/** The world of that name; throws ConfigError, listing the names there are, for any other. */
World makeWorld(const std::string& name);

}  // namespace submap_slam
