#pragma once

#include <mrpt/obs/CObservationBearingRange.h>
#include <submap_slam/core/frame.h>
#include <submap_slam/rawlog/log_report.h>

namespace submap_slam {

/** Whether the pose and the limits of the sensor make sense. */
bool isUsable(const mrpt::obs::CObservationBearingRange& observation);

/** The landmarks of a usable observation, projected to the plane of the robot. Measurements that are broken
 * or nearer than `min_range` (m) are left out and counted. */
LandmarkScan toLandmarkScan(const mrpt::obs::CObservationBearingRange& observation, double min_range,
                            LandmarkSensorReport& counts);

}  // namespace submap_slam
