#include "odometry_track.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <chrono>

namespace submap_slam {
namespace {

// Some seconds at 100 Hz: scans are logged late by less than that.
constexpr std::size_t kMaxReadings = 1024;

}  // namespace

double secondsBetween(mrpt::Clock::time_point a, mrpt::Clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

mrpt::math::TPose2D interpolate(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b, double share) {
  const double turn = mrpt::math::wrapToPi(b.phi - a.phi);
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), mrpt::math::wrapToPi(a.phi + share * turn)};
}

bool OdometryTrack::add(mrpt::Clock::time_point stamp, const mrpt::math::TPose2D& pose) {
  if (!readings_.empty() && stamp < readings_.back().stamp) return false;
  readings_.push_back({stamp, pose});
  if (readings_.size() > kMaxReadings) readings_.pop_front();
  return true;
}

std::optional<mrpt::Clock::time_point> OdometryTrack::lastStamp() const {
  if (readings_.empty()) return std::nullopt;
  return readings_.back().stamp;
}

std::optional<mrpt::math::TPose2D> OdometryTrack::at(mrpt::Clock::time_point stamp) const {
  if (readings_.empty()) return std::nullopt;
  const auto after =
      std::upper_bound(readings_.begin(), readings_.end(), stamp,
                       [](mrpt::Clock::time_point t, const Reading& reading) { return t < reading.stamp; });
  if (after == readings_.begin()) return hold(*after, stamp);
  const Reading& before = *std::prev(after);
  if (before.stamp == stamp || after == readings_.end()) return hold(before, stamp);
  const double share = secondsBetween(before.stamp, stamp) / secondsBetween(before.stamp, after->stamp);
  return interpolate(before.pose, after->pose, share);
}

std::optional<mrpt::math::TPose2D> OdometryTrack::hold(const Reading& end, mrpt::Clock::time_point stamp) {
  if (std::abs(secondsBetween(stamp, end.stamp)) > kHoldSeconds) return std::nullopt;
  return end.pose;
}

}  // namespace submap_slam
