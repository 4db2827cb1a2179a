#pragma once

#include <submap_slam/core/frame.h>
#include <submap_slam/rawlog/log_report.h>

#include <map>
#include <optional>
#include <string>

namespace submap_slam {

/** Adds delivered frames to the counts of a report. */
class LogStatistics {
 public:
  /** Counts the frame and invalidates its unusable beams. */
  void add(Frame& frame, double min_range, LogReport& report);

 private:
  void addStamp(const Frame& frame, LogReport& report);
  void addOdometry(const Frame& frame, LogReport& report);
  void addScan(const mrpt::obs::CObservation2DRangeScan& scan, ScannerReport& scanner);
  void addLandmarks(const LandmarkScan& scan, LandmarkSensorReport& sensor);

  std::optional<mrpt::math::TPose2D> last_odometry_;
  mrpt::Clock::time_point last_stamp_{};
  std::map<std::string, mrpt::obs::CObservation2DRangeScan::Ptr> last_scan_;
};

}  // namespace submap_slam
