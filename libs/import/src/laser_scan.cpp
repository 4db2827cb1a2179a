#include "laser_scan.h"

#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPose3D.h>

#include <cmath>

namespace submap_slam {

using mrpt::math::TPose2D;

mrpt::obs::CObservation2DRangeScan makeScan(const Scanner& scanner, double stamp_s,
                                            const std::vector<double>& ranges_m) {
  mrpt::obs::CObservation2DRangeScan scan;
  scan.sensorLabel = scanner.label;
  scan.timestamp = mrpt::Clock::fromDouble(stamp_s);
  scan.rightToLeft = scanner.angles.step >= 0;
  const double span = scanner.angles.step * static_cast<double>(ranges_m.size() - 1);  // first to last beam
  scan.aperture = static_cast<float>(std::abs(span));
  scan.maxRange = static_cast<float>(scanner.max_range);
  scan.sensorPose = mrpt::poses::CPose3D(
      mrpt::poses::CPose2D(scanner.T_robot_sensor + TPose2D(0, 0, scanner.angles.first + span / 2)));
  scan.resizeScan(ranges_m.size());
  for (std::size_t i = 0; i < ranges_m.size(); ++i) {
    const bool measured = std::isfinite(ranges_m[i]) && ranges_m[i] > 0;
    scan.setScanRange(i, measured ? static_cast<float>(ranges_m[i]) : 0.0F);
    scan.setScanRangeValidity(i, measured && ranges_m[i] < scanner.max_range);
  }
  return scan;
}

mrpt::obs::CObservationOdometry makeOdometry(double stamp_s, const TPose2D& T_odom_robot) {
  mrpt::obs::CObservationOdometry odometry;
  odometry.timestamp = mrpt::Clock::fromDouble(stamp_s);
  odometry.sensorLabel = "ODOMETRY";
  odometry.odometry = mrpt::poses::CPose2D(T_odom_robot);
  return odometry;
}

}  // namespace submap_slam
