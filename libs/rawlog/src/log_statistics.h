#pragma once

#include <submap_slam/core/frame.h>
#include <submap_slam/rawlog/log_report.h>

#include <map>
#include <optional>
#include <string>

namespace submap_slam {

/** How fast something changed in the last second or so. */
class RecentRate {
 public:
  /** The change that so many seconds at this rate bring. */
  double over(double seconds) const { return time_s_ > 0 ? change_ / time_s_ * seconds : 0; }

  void add(double change, double seconds);

  /** Whether anything was added. */
  bool known() const { return known_; }

 private:
  double change_ = 0, time_s_ = 0;  ///< faded sums
  bool known_ = false;
};

/** Adds delivered frames to the counts of a report. */
class LogStatistics {
 public:
  /** Counts the frame and invalidates its unusable beams. */
  void add(Frame& frame, double min_range, LogReport& report);

 private:
  void addStamp(const Frame& frame, LogReport& report);
  void addOdometry(const Frame& frame, LogReport& report);
  void addStep(const mrpt::math::TPose2D& from, const Frame& to, LogReport& report);
  void addScan(const mrpt::obs::CObservation2DRangeScan& scan, ScannerReport& scanner);
  void addLandmarks(const LandmarkScan& scan, LandmarkSensorReport& sensor);

  std::optional<mrpt::math::TPose2D> last_odometry_;
  mrpt::Clock::time_point last_stamp_{}, last_odometry_stamp_{};
  RecentRate speed_, turn_rate_;
  std::map<std::string, mrpt::obs::CObservation2DRangeScan::Ptr> last_scan_;
};

}  // namespace submap_slam
