#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/math/CMatrixFixed.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace submap_slam {

/** A landmark as a sensor measured it. */
struct LandmarkMeasurement {
  double range = 0;            ///< m
  double bearing = 0;          ///< rad, from the sensor's x axis, left positive
  std::optional<uint32_t> id;  ///< which landmark it is, if the log says so
};

/** The landmarks that one sensor saw at one instant; none is an observation too. */
struct LandmarkScan {
  mrpt::math::TPose2D T_robot_sensor;  ///< m, rad
  double max_range = 0;                ///< m; 0: not known
  double field_of_view = 0;            ///< rad, symmetric to the sensor's x axis; 0: not known
  double sigma_range = 0;              ///< m; 0: the log does not say
  double sigma_bearing = 0;            ///< rad; 0: the log does not say
  std::vector<LandmarkMeasurement> measurements;
  std::string sensor_label;
};

/** One instant of the log: what the sensors saw then and where odometry says the robot was. */
struct Frame {
  /** Position among the frames of the whole log, from 0; boundaries and random streams are named by it. */
  std::size_t index = 0;

  mrpt::Clock::time_point stamp;

  /** T_odom_robot, interpolated to the stamp (m, rad); empty where the log has no odometry. */
  std::optional<mrpt::math::TPose2D> odometry;

  /** Scans with this stamp; `sensorPose` is the pose of each scanner on the robot. */
  std::vector<mrpt::obs::CObservation2DRangeScan::Ptr> scans;

  /** Landmarks seen with this stamp. A frame has a scan, or landmarks, or both. */
  std::vector<LandmarkScan> landmark_scans{};

  /** Covariance of the motion since the frame before, seen from the robot there (m², m·rad, rad²), where
   * the reader derives odometry from a model of the vehicle; empty: the mapper's own motion model counts. */
  std::optional<mrpt::math::CMatrixDouble33> motion_covariance{};
};

}  // namespace submap_slam
