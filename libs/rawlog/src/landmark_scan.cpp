#include "landmark_scan.h"

#include <mrpt/math/wrap2pi.h>

#include <cmath>

#include "scan_check.h"

namespace submap_slam {
namespace {

using mrpt::obs::CObservationBearingRange;

/** A limit or standard deviation of the log; 0, "not known", if it makes no sense. */
double knownOrZero(float value) { return std::isfinite(value) && value > 0 ? static_cast<double>(value) : 0; }

/** Root mean square of the standard deviations of one variable (0: range, 1: yaw) over all measurements. */
double commonSigma(const CObservationBearingRange& observation, int variable) {
  double sum = 0;
  for (const auto& m : observation.sensedData) sum += m.covariance(variable, variable);
  const auto count = static_cast<double>(observation.sensedData.size());
  return count > 0 && std::isfinite(sum) && sum > 0 ? std::sqrt(sum / count) : 0;
}

bool isWhole(const CObservationBearingRange::TMeasurement& m) {
  return std::isfinite(m.range) && m.range > 0 && std::isfinite(m.yaw) && std::isfinite(m.pitch);
}

/** Range and bearing in the horizontal plane through the sensor, seen from its pose in the plane. */
LandmarkMeasurement project(const CObservationBearingRange::TMeasurement& m,
                            const mrpt::poses::CPose3D& T_robot_sensor) {
  const double range = static_cast<double>(m.range), yaw = static_cast<double>(m.yaw),
               pitch = static_cast<double>(m.pitch);
  const mrpt::math::TPoint3D in_sensor(range * std::cos(yaw) * std::cos(pitch),
                                       range * std::sin(yaw) * std::cos(pitch), -range * std::sin(pitch));
  const mrpt::math::TPoint3D offset = T_robot_sensor.rotateVector(in_sensor);
  return {std::hypot(offset.x, offset.y),
          mrpt::math::wrapToPi(std::atan2(offset.y, offset.x) - T_robot_sensor.yaw()),
          m.landmarkID >= 0 ? std::optional<uint32_t>(m.landmarkID) : std::nullopt};
}

}  // namespace

bool isUsable(const CObservationBearingRange& observation) {
  return isSound(observation.validCovariances) && isFinite(observation.sensorLocationOnRobot.asTPose());
}

LandmarkScan toLandmarkScan(const CObservationBearingRange& observation, double min_range,
                            LandmarkSensorReport& counts) {
  const auto& pose = observation.sensorLocationOnRobot;
  LandmarkScan scan;
  scan.sensor_label = observation.sensorLabel;
  scan.T_robot_sensor = {pose.x(), pose.y(), pose.yaw()};
  scan.max_range = knownOrZero(observation.maxSensorDistance);
  scan.field_of_view = knownOrZero(observation.fieldOfView_yaw);
  const bool own = observation.validCovariances;  // each measurement has a covariance of its own
  scan.sigma_range = own ? commonSigma(observation, 0) : knownOrZero(observation.sensor_std_range);
  scan.sigma_bearing = own ? commonSigma(observation, 1) : knownOrZero(observation.sensor_std_yaw);
  for (const auto& sensed : observation.sensedData) {
    if (!isWhole(sensed)) {
      ++counts.broken;
      continue;
    }
    const LandmarkMeasurement measurement = project(sensed, pose);
    if (measurement.range >= min_range) {
      scan.measurements.push_back(measurement);
    } else {
      ++counts.near;
    }
  }
  return scan;
}

}  // namespace submap_slam
