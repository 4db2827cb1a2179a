#include "log_statistics.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>

#include "odometry_track.h"
#include "scan_check.h"

namespace submap_slam {
namespace {

constexpr double kBurstStep_s = 0.01;
constexpr double kJump_m = 1.0;
const double kJump_rad = mrpt::DEG2RAD(45.0);
constexpr double kSparseStep_s = 0.5;

/** Some converters compute the sensor pose anew for each scan: differences that move no beam visibly are
 * none. */
bool samePose(const mrpt::math::TPose3D& a, const mrpt::math::TPose3D& b) {
  constexpr double kSame = 1e-3;  // m and rad
  const double turn = mrpt::math::wrapToPi(a.yaw - b.yaw);
  return std::hypot(a.x - b.x, a.y - b.y) < kSame && std::abs(a.z - b.z) < kSame && std::abs(turn) < kSame;
}

bool sameGeometry(const mrpt::obs::CObservation2DRangeScan& a, const mrpt::obs::CObservation2DRangeScan& b) {
  return a.getScanSize() == b.getScanSize() && a.aperture == b.aperture && a.maxRange == b.maxRange &&
         a.rightToLeft == b.rightToLeft && samePose(a.sensorPose.asTPose(), b.sensorPose.asTPose());
}

/** Whether a step is no movement like those before, to which it counts from then on; the first of all steps
 * may be of any speed. */
bool isJump(RecentRate& rate, double step, double seconds, double threshold) {
  if (!rate.known()) {
    rate.add(step, seconds);
    return false;
  }
  const double largest = threshold + 2 * rate.over(seconds);
  rate.add(std::min(step, largest), seconds);
  return step > largest;
}

}  // namespace

void RecentRate::add(double change, double seconds) {
  constexpr double kMemory_s = 1;
  const double left = std::exp(-seconds / kMemory_s);
  change_ = left * change_ + change;
  time_s_ = left * time_s_ + seconds;
  known_ = true;
}

void LogStatistics::add(Frame& frame, double min_range, LogReport& report) {
  addStamp(frame, report);
  addOdometry(frame, report);
  for (const auto& scan : frame.scans) {
    auto& scanner = report.scanners[scan->sensorLabel];
    invalidateBeams(*scan, min_range, scanner);
    auto& last = last_scan_[scan->sensorLabel];
    if (last) {
      const double step_s = secondsBetween(last->timestamp, scan->timestamp);
      if (step_s >= 0 && step_s < kBurstStep_s) ++scanner.burst_steps;
      if (!sameGeometry(*last, *scan)) ++scanner.geometry_changes;
    }
    addScan(*scan, scanner);
    last = scan;
  }
  for (const LandmarkScan& scan : frame.landmark_scans)
    addLandmarks(scan, report.landmark_sensors[scan.sensor_label]);
  ++report.frames;
}

void LogStatistics::addStamp(const Frame& frame, LogReport& report) {
  if (report.frames == 0) {
    report.first_stamp = report.last_stamp = frame.stamp;
  } else {
    if (frame.stamp < last_stamp_) ++report.backward_stamps;
    if (frame.stamp == last_stamp_) ++report.equal_stamps;
    report.largest_gap_s = std::max(report.largest_gap_s, secondsBetween(last_stamp_, frame.stamp));
    report.first_stamp = std::min(report.first_stamp, frame.stamp);
    report.last_stamp = std::max(report.last_stamp, frame.stamp);
  }
  last_stamp_ = frame.stamp;
}

void LogStatistics::addOdometry(const Frame& frame, LogReport& report) {
  if (frame.odometry) {
    ++report.frames_with_odometry;
    if (last_odometry_) addStep(*last_odometry_, frame, report);
  }
  last_odometry_ = frame.odometry;
  last_odometry_stamp_ = frame.stamp;
}

void LogStatistics::addStep(const mrpt::math::TPose2D& from, const Frame& to, LogReport& report) {
  const double step_m = std::hypot(to.odometry->x - from.x, to.odometry->y - from.y);
  const double step_rad = std::abs(mrpt::math::wrapToPi(to.odometry->phi - from.phi));
  const double seconds = std::max(0.0, secondsBetween(last_odometry_stamp_, to.stamp));
  report.path_length_m += step_m;
  report.largest_step_m = std::max(report.largest_step_m, step_m);
  report.largest_step_rad = std::max(report.largest_step_rad, step_rad);
  if (seconds > kSparseStep_s && (step_m > kJump_m || step_rad > kJump_rad)) ++report.sparse_steps;
  const bool leaps = isJump(speed_, step_m, seconds, kJump_m);
  const bool spins = isJump(turn_rate_, step_rad, seconds, kJump_rad);
  if (leaps || spins) ++report.odometry_jumps;
}

void LogStatistics::addScan(const mrpt::obs::CObservation2DRangeScan& scan, ScannerReport& scanner) {
  if (scanner.scans++ > 0) return;
  scanner.beams = scan.getScanSize();
  scanner.aperture = scan.aperture;
  scanner.max_range = scan.maxRange;
  scanner.sensor_pose = scan.sensorPose.asTPose();
}

void LogStatistics::addLandmarks(const LandmarkScan& scan, LandmarkSensorReport& sensor) {
  if (sensor.observations++ == 0) {
    sensor.max_range = scan.max_range;
    sensor.sigma_range = scan.sigma_range;
    sensor.sigma_bearing = scan.sigma_bearing;
    sensor.sensor_pose = scan.T_robot_sensor;
  }
  if (scan.measurements.empty()) ++sensor.empty;
  sensor.measurements += scan.measurements.size();
  for (const LandmarkMeasurement& measurement : scan.measurements) {
    sensor.largest_range = std::max(sensor.largest_range, measurement.range);
    if (!measurement.id) continue;
    ++sensor.with_id;
    sensor.ids.insert(*measurement.id);
  }
}

}  // namespace submap_slam
