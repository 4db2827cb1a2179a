#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace submap_slam {

/** One instant of the log: the scans taken then and where odometry says the robot was. */
struct Frame {
  /** Position among the frames of the whole log, from 0; boundaries and random streams are named by it. */
  std::size_t index = 0;

  mrpt::Clock::time_point stamp;

  /** T_odom_robot, interpolated to the stamp (m, rad); empty where the log has no odometry. */
  std::optional<mrpt::math::TPose2D> odometry;

  /** Scans with this stamp; `sensorPose` is the pose of each scanner on the robot. Never empty. */
  std::vector<mrpt::obs::CObservation2DRangeScan::Ptr> scans;
};

}  // namespace submap_slam
