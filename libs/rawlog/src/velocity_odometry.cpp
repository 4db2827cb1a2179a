#include "velocity_odometry.h"

#include <algorithm>
#include <iterator>

#include "odometry_track.h"

namespace submap_slam {
namespace {

/** A velocity is not believed for longer than a reading is (s). */
double held(double seconds) { return std::clamp(seconds, 0.0, OdometryTrack::kHoldSeconds); }

}  // namespace

mrpt::math::TPose2D VelocityOdometry::add(mrpt::Clock::time_point stamp,
                                          const mrpt::math::TTwist2D& velocity) {
  if (!readings_.empty()) {
    const Reading& last = readings_.back();
    pose_ = moved(pose_, last.velocity, held(secondsBetween(last.stamp, stamp)));
    if (stamp < last.stamp) readings_.clear();  // the clock jumped back: nothing is known across the jump
  }
  readings_.push_back({stamp, velocity});
  return pose_;
}

std::optional<mrpt::math::CMatrixDouble33> VelocityOdometry::covariance(mrpt::Clock::time_point from,
                                                                        mrpt::Clock::time_point to) {
  if (from >= to) return std::nullopt;
  while (readings_.size() > 1 && readings_[1].stamp <= from) readings_.pop_front();
  if (readings_.empty() || readings_.front().stamp > from) return std::nullopt;
  UncertainMotion motion(params_);
  for (auto reading = readings_.begin(); reading != readings_.end() && reading->stamp < to; ++reading) {
    const auto next = std::next(reading);
    const bool last = next == readings_.end() || next->stamp >= to;
    const auto begin = std::max(from, reading->stamp), end = last ? to : next->stamp;
    const double dt = secondsBetween(begin, end);
    if (dt > OdometryTrack::kHoldSeconds) return std::nullopt;
    const double period = next == readings_.end() ? dt : secondsBetween(reading->stamp, next->stamp);
    motion.step(reading->velocity, dt, period);
  }
  return motion.covariance();
}

}  // namespace submap_slam
