#pragma once

#include <mrpt/math/wrap2pi.h>
#include <submap_slam/mapping/laser_points.h>
#include <submap_slam/simulation/simulate.h>

#include <cmath>
#include <vector>

namespace submap_slam {

/** Points of one sweep from the robot's origin, without normals. */
inline LaserPoints pointsAt(const std::vector<LaserPoint>& points) {
  LaserPoints scan;
  scan.points = points;
  scan.sweeps.push_back({{0, 0}, 0, points.size()});
  return scan;
}

/** Points each 2 cm on the segment from (x0, y0) to (x1, y1), without normals. */
inline LaserPoints wallPoints(float x0, float y0, float x1, float y1) {
  std::vector<LaserPoint> points;
  const auto n = static_cast<int>(std::hypot(x1 - x0, y1 - y0) / 0.02f);
  for (int i = 0; i <= n; ++i) {
    const float u = static_cast<float>(i) / static_cast<float>(n);
    points.push_back({x0 + u * (x1 - x0), y0 + u * (y1 - y0)});
  }
  return pointsAt(points);
}

/** A room of 6 × 4 m with a box in a corner; the origin lies near its middle. */
inline World boxRoom() {
  return {"",
          {{{-2.7, -1.9}, {3.3, -1.9}},
           {{3.3, -1.9}, {3.3, 2.1}},
           {{3.3, 2.1}, {-2.7, 2.1}},
           {{-2.7, 2.1}, {-2.7, -1.9}},
           {{2.1, 1.4}, {2.7, 1.4}},
           {{2.1, 1.4}, {2.1, 2.1}},
           {{2.7, 1.4}, {2.7, 2.1}}},
          {}};
}

/** Two walls along x, 2 m apart, whose ends a laser of 10 m does not see. */
inline World endlessCorridor() { return {"", {{{-50, -1.2}, {50, -1.2}}, {{-50, 0.8}, {50, 0.8}}}, {}}; }

/** A laser all around without noise, at the robot's origin. */
inline LaserModel exactLaser() {
  LaserModel laser;
  laser.beams = 361;
  laser.aperture = 2 * M_PI;
  laser.sigma_range = 0;
  laser.range_step = 0;
  laser.sensor_pose = {};
  return laser;
}

/** What a laser sees from T_world_robot. */
inline LaserPoints scanFrom(const World& world, const mrpt::math::TPose2D& pose,
                            const LaserModel& laser = exactLaser()) {
  const auto log = simulate(world, Path{0.1, {pose}}, laser, OdometryModel::perfect(), 1);
  return toLaserPoints(log.frames.front(), 1e9);
}

inline double distance(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

inline double turn(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b) {
  return std::abs(mrpt::math::wrapToPi(a.phi - b.phi));
}

}  // namespace submap_slam
