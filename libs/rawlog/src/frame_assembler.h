#pragma once

#include <submap_slam/core/frame.h>

#include <deque>
#include <functional>
#include <optional>

#include "odometry_track.h"

namespace submap_slam {

/** A frame and the rawlog entry its first scan or landmark observation came from. */
struct LoggedFrame {
  Frame frame;
  uint64_t entry = 0;
};

/** Puts scans, landmarks and odometry, in the order of the log, together to frames (rules: see RawlogReader).
 */
class FrameAssembler {
 public:
  /** An odometry increment T_last_now; false if the log's odometry comes as readings, then it is ignored. */
  bool addIncrement(const mrpt::math::TPose2D& increment);

  /** An odometry reading T_odom_robot; false if the log's odometry comes as increments, then it is ignored.
   */
  bool addReading(mrpt::Clock::time_point stamp, const mrpt::math::TPose2D& pose);

  void addScan(const mrpt::obs::CObservation2DRangeScan::Ptr& scan, uint64_t entry);
  void addLandmarks(mrpt::Clock::time_point stamp, LandmarkScan scan, uint64_t entry);

  /** The next scan or landmark observation starts another frame, whatever its stamp. */
  void closeFrame() { open_ = false; }

  /** Nothing more will be added. */
  void finish();

  /** The next frame that is complete, in the order of the log. */
  std::optional<LoggedFrame> pop();

 private:
  enum class OdometryKind { kNoneYet, kIncrements, kReadings };
  struct Pending {
    LoggedFrame logged;
    bool odometry_settled = false;
  };

  /** The frame that what a sensor saw at that stamp belongs to; a new one if the last frame has another
   * stamp or, by `holds`, something of this sensor. */
  Frame& frameFor(mrpt::Clock::time_point stamp, uint64_t entry,
                  const std::function<bool(const Frame&)>& holds);
  Pending makeFrame(mrpt::Clock::time_point stamp, uint64_t entry);
  void settle(Pending& pending) const;
  bool isReached(const Pending& pending) const;

  OdometryKind kind_ = OdometryKind::kNoneYet;
  OdometryTrack track_;
  mrpt::math::TPose2D chained_{0, 0, 0};
  std::deque<Pending> pending_;
  std::size_t next_index_ = 0;
  bool open_ = false, finished_ = false;
};

}  // namespace submap_slam
