#pragma once

#include <submap_slam/core/frame.h>
#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace submap_slam {

/** Endpoint of a beam in the robot frame. */
struct LaserPoint {
  float x = 0, y = 0;  ///< m
  /** Normal of the surface seen in the scan, on the side of the scanner; its length is the cosine of the
   * angle of incidence, thus how sure that side is. (0, 0): unknown. */
  float normal_x = 0, normal_y = 0;
};

/** The valid beams of one scanner: they all start at its position on the robot. */
struct LaserSweep {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< sensor position in the robot frame (m)
  std::size_t begin = 0, end = 0;                    ///< range of points
};

/** What all scanners saw at one instant, in the robot frame. */
struct LaserPoints {
  std::vector<LaserPoint> points;
  std::vector<LaserSweep> sweeps;
};

/** Endpoints of all valid beams (finite range in (0, max_range]) with exact beam angles, sensor pose and
 * scanning direction respected. @param max_range m; beams beyond it are dropped */
LaserPoints toLaserPoints(const Frame& frame, double max_range);

}  // namespace submap_slam
