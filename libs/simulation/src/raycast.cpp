#include <submap_slam/simulation/world.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace submap_slam {
namespace {

using mrpt::math::TPoint2D;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/** Walls reach this share of their length beyond their ends, so that no ray slips between two that share a
 * corner. */
constexpr double kEndTolerance = 1e-12;

double cross(const TPoint2D& a, const TPoint2D& b) { return a.x * b.y - a.y * b.x; }
double dot(const TPoint2D& a, const TPoint2D& b) { return a.x * b.x + a.y * b.y; }

/** Solves origin + t · direction = a + s (b − a) for t ≥ 0 with s in [0, 1]; infinity if there is no such t.
 */
double distanceToWall(const TPoint2D& origin, const TPoint2D& direction, const Wall& wall) {
  const TPoint2D along = wall.b - wall.a, to_a = wall.a - origin;
  const double signed_denominator = cross(direction, along);
  if (signed_denominator == 0) return kInfinity;
  const double sign = std::copysign(1.0, signed_denominator), denominator = sign * signed_denominator;
  const double s = sign * cross(to_a, direction),
               t = sign * cross(to_a, along);  // both times the denominator
  const double tolerance = kEndTolerance * denominator;
  const bool hit = s >= -tolerance && s <= denominator + tolerance && t >= 0;
  return hit ? t / denominator : kInfinity;
}

double distanceToPoint(const TPoint2D& point, const Wall& wall) {
  const TPoint2D along = wall.b - wall.a;
  const double s = std::clamp(dot(point - wall.a, along) / dot(along, along), 0.0, 1.0);
  return (wall.a + along * s - point).norm();
}

}  // namespace

double World::raycast(const TPoint2D& origin, double angle) const {
  const TPoint2D direction{std::cos(angle), std::sin(angle)};
  double nearest = kInfinity;
  for (const Wall& wall : walls) nearest = std::min(nearest, distanceToWall(origin, direction, wall));
  return nearest;
}

double World::clearance(const TPoint2D& point) const {
  double nearest = kInfinity;
  for (const Wall& wall : walls) nearest = std::min(nearest, distanceToPoint(point, wall));
  return nearest;
}

}  // namespace submap_slam
