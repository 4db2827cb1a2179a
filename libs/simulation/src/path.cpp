#include <mrpt/math/wrap2pi.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/simulation/path.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "constants.h"

namespace submap_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/** Sharper turns are made on the spot: their arc would leave the legs far from the way point (rad). */
constexpr double kSharpestArc = 150.0 / 180.0 * kPi;
constexpr double kSmallestTurn = 1e-9;

/** Speed and turn rate constant for a while. */
struct Motion {
  TPose2D start;
  double speed, turn_rate;  ///< m/s, rad/s
  double duration;          ///< s

  TPose2D after(double time) const {
    const double phi = start.phi + turn_rate * time;
    if (turn_rate == 0)
      return {start.x + speed * time * std::cos(phi), start.y + speed * time * std::sin(phi), phi};
    const double radius = speed / turn_rate;
    return {start.x + radius * (std::sin(phi) - std::sin(start.phi)),
            start.y - radius * (std::cos(phi) - std::cos(start.phi)), phi};
  }

  TPose2D end() const { return after(duration); }
};

/** Puts motions one after the other. */
class Driver {
 public:
  Driver(const TPose2D& start, const DriveLimits& limits) : pose_(start), limits_(limits) {}

  void straight(double length) {
    if (length > 0) append(limits_.max_speed, 0, length / limits_.max_speed);
  }

  /** Turns left (positive) or right by an angle on an arc; radius 0 turns on the spot. */
  void turn(double angle, double radius) {
    const double rate = radius * limits_.max_turn_rate > limits_.max_speed ? limits_.max_speed / radius
                                                                           : limits_.max_turn_rate;
    append(radius * rate, std::copysign(rate, angle), std::abs(angle) / rate);
  }

  const std::vector<Motion>& motions() const { return motions_; }

 private:
  void append(double speed, double turn_rate, double duration) {
    motions_.push_back({pose_, speed, turn_rate, duration});
    pose_ = motions_.back().end();
  }

  TPose2D pose_;
  DriveLimits limits_;
  std::vector<Motion> motions_;
};

struct Leg {
  double length, heading;
};

std::vector<Leg> legsBetween(const WayPoints& points) {
  std::vector<Leg> legs;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const TPoint2D leg = points[i] - points[i - 1];
    if (!(leg.norm() > 0) || !std::isfinite(leg.norm()))
      throw ConfigError("way point " + std::to_string(i) + " must be finite and differ from the one before");
    legs.push_back({leg.norm(), std::atan2(leg.y, leg.x)});
  }
  return legs;
}

/** How a corner between two legs is driven. */
struct Corner {
  double angle = 0, radius = 0;
  double cut = 0;  ///< length of leg on each side that the arc replaces (m)
};

Corner cornerBetween(const Leg& in, const Leg& out, double wanted_radius) {
  double angle = mrpt::math::wrapToPi(out.heading - in.heading);
  if (angle < -kPi + kSmallestTurn) angle = kPi;  // a full reversal turns left, whatever the rounding
  if (std::abs(angle) > kSharpestArc || std::abs(angle) < kSmallestTurn) return {angle, 0, 0};
  const double tangent = std::tan(std::abs(angle) / 2);
  const double radius = std::min(wanted_radius, std::min(in.length, out.length) / 2 / tangent);
  return {angle, radius, radius * tangent};
}

std::vector<Motion> motionsAlong(const WayPoints& points, const DriveLimits& limits) {
  const std::vector<Leg> legs = legsBetween(points);
  Driver driver({points[0].x, points[0].y, legs[0].heading}, limits);
  double cut_before = 0;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const bool last = i + 1 == legs.size();
    const Corner corner = last ? Corner{} : cornerBetween(legs[i], legs[i + 1], limits.corner_radius);
    driver.straight(legs[i].length - cut_before - corner.cut);
    if (std::abs(corner.angle) >= kSmallestTurn) driver.turn(corner.angle, corner.radius);
    cut_before = corner.cut;
  }
  return driver.motions();
}

std::vector<TPose2D> sample(const std::vector<Motion>& motions, double period) {
  constexpr double kRounding = 1e-9;  // s; a pose due exactly at the end is not lost
  std::vector<TPose2D> poses;
  double begin = 0;
  for (const Motion& motion : motions) {
    const double end = begin + motion.duration;
    for (double time; (time = static_cast<double>(poses.size()) * period) <= end + kRounding;) {
      TPose2D pose = motion.after(time - begin);
      pose.phi = mrpt::math::wrapToPi(pose.phi);
      poses.push_back(pose);
    }
    begin = end;
  }
  return poses;
}

void requirePositive(double value, const char* name) {
  if (!(value > 0) || !std::isfinite(value)) throw ConfigError(std::string(name) + " must be positive");
}

}  // namespace

Path drive(const WayPoints& way_points, const DriveLimits& limits, double rate) {
  if (way_points.size() < 2) throw ConfigError("a path needs at least two way points");
  requirePositive(limits.max_speed, "max_speed");
  requirePositive(limits.max_turn_rate, "max_turn_rate");
  requirePositive(limits.corner_radius, "corner_radius");
  requirePositive(rate, "rate");
  const double period = 1 / rate;
  return {period, sample(motionsAlong(way_points, limits), period)};
}

}  // namespace submap_slam
