#include "frame_assembler.h"

#include <algorithm>

namespace submap_slam {
namespace {

// Frames that may wait for the odometry behind them; a log without odometry delays its frames by as many.
constexpr std::size_t kMaxPending = 256;

}  // namespace

bool FrameAssembler::addIncrement(const mrpt::math::TPose2D& increment) {
  if (kind_ == OdometryKind::kReadings) return false;
  if (kind_ == OdometryKind::kNoneYet)
    for (auto& waiting : pending_) {
      waiting.logged.frame.odometry = chained_;
      waiting.odometry_settled = true;
    }
  kind_ = OdometryKind::kIncrements;
  chained_ = chained_ + increment;
  return true;
}

bool FrameAssembler::addReading(mrpt::Clock::time_point stamp, const mrpt::math::TPose2D& pose) {
  if (kind_ == OdometryKind::kIncrements) return false;
  kind_ = OdometryKind::kReadings;
  if (!track_.add(stamp,
                  pose)) {  // the clock jumped back: a new track, nothing is interpolated across the jump
    for (auto& waiting : pending_) settle(waiting);
    track_.clear();
    track_.add(stamp, pose);
  }
  for (auto& waiting : pending_)
    if (isReached(waiting)) settle(waiting);
  return true;
}

void FrameAssembler::addScan(const mrpt::obs::CObservation2DRangeScan::Ptr& scan, uint64_t entry) {
  const auto holds = [&](const Frame& frame) {
    return std::any_of(frame.scans.begin(), frame.scans.end(),
                       [&](const auto& other) { return other->sensorLabel == scan->sensorLabel; });
  };
  frameFor(scan->timestamp, entry, holds).scans.push_back(scan);
}

void FrameAssembler::addLandmarks(mrpt::Clock::time_point stamp, LandmarkScan scan, uint64_t entry) {
  const auto holds = [&](const Frame& frame) {
    return std::any_of(frame.landmark_scans.begin(), frame.landmark_scans.end(),
                       [&](const LandmarkScan& other) { return other.sensor_label == scan.sensor_label; });
  };
  frameFor(stamp, entry, holds).landmark_scans.push_back(std::move(scan));
}

/** Two scans of one sensor are never one frame: some logs give the same stamp to all scans of a burst. */
Frame& FrameAssembler::frameFor(mrpt::Clock::time_point stamp, uint64_t entry,
                                const std::function<bool(const Frame&)>& holds) {
  const bool last = open_ && !pending_.empty() && pending_.back().logged.frame.stamp == stamp &&
                    !holds(pending_.back().logged.frame);
  if (!last) pending_.push_back(makeFrame(stamp, entry));
  open_ = true;
  return pending_.back().logged.frame;
}

FrameAssembler::Pending FrameAssembler::makeFrame(mrpt::Clock::time_point stamp, uint64_t entry) {
  Pending added;
  added.logged.entry = entry;
  Frame& frame = added.logged.frame;
  frame.index = next_index_++;
  frame.stamp = stamp;
  if (kind_ == OdometryKind::kIncrements) {
    frame.odometry = chained_;
    added.odometry_settled = true;
  } else if (isReached(
                 added)) {  // at once: later readings may have the same stamp, but belong to later scans
    settle(added);
  }
  return added;
}

void FrameAssembler::settle(Pending& pending) const {
  if (pending.odometry_settled) return;
  pending.logged.frame.odometry = track_.at(pending.logged.frame.stamp);
  pending.odometry_settled = true;
}

bool FrameAssembler::isReached(const Pending& pending) const {
  return track_.lastStamp() && pending.logged.frame.stamp <= *track_.lastStamp();
}

void FrameAssembler::finish() {
  open_ = false;
  finished_ = true;
}

std::optional<LoggedFrame> FrameAssembler::pop() {
  if (pending_.empty() || (open_ && pending_.size() == 1)) return std::nullopt;
  Pending& front = pending_.front();
  if (!front.odometry_settled && !finished_ && pending_.size() <= kMaxPending) return std::nullopt;
  settle(front);
  LoggedFrame logged = std::move(front.logged);
  pending_.pop_front();
  return logged;
}

}  // namespace submap_slam
