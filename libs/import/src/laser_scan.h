#pragma once

#include <mrpt/math/TPose2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <submap_slam/import/import.h>

#include <string>
#include <vector>

namespace submap_slam {

/** Scanner of a scan. */
struct Scanner {
  std::string label;
  mrpt::math::TPose2D T_robot_sensor;  ///< m, rad; the x axis points where angle 0 is
  BeamAngles angles;
  double max_range = 0;  ///< m; ranges at or above are no return
};

/** A scan of MRPT, whose angles are symmetric to the x axis of the sensor: it points to the middle of the
 * beams. Ranges that are no return, not positive or not finite become invalid; these last ones also 0. */
mrpt::obs::CObservation2DRangeScan makeScan(const Scanner& scanner, double stamp_s,
                                            const std::vector<double>& ranges_m);

/** An odometry reading with the label ODOMETRY. */
mrpt::obs::CObservationOdometry makeOdometry(double stamp_s, const mrpt::math::TPose2D& T_odom_robot);

}  // namespace submap_slam
