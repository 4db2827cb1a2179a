#pragma once

#include <mrpt/math/wrap2pi.h>
#include <mrpt/poses/CPose2D.h>
#include <submap_slam/mapping/grid_mapper.h>
#include <submap_slam/mapping/stretch_splitter.h>
#include <submap_slam/simulation/simulate.h>

#include <cmath>
#include <vector>

namespace submap_slam {

inline std::vector<Stretch> stretchesOf(const std::vector<Frame>& frames, const StretchParams& params = {}) {
  StretchSplitter splitter(params);
  std::vector<Stretch> stretches;
  for (const auto& frame : frames)
    if (auto stretch = splitter.push(frame)) stretches.push_back(std::move(*stretch));
  if (auto stretch = splitter.finish()) stretches.push_back(std::move(*stretch));
  return stretches;
}

/** All submaps of a log, in order. */
inline GridSubmaps mapLog(const std::vector<Frame>& frames, const GridMapperParams& params, uint64_t seed = 1,
                          const StretchParams& stretching = {}) {
  const auto mapper = makeGridMapper(params, seed);
  GridSubmaps submaps;
  for (const auto& stretch : stretchesOf(frames, stretching))
    for (const auto& submap : mapper->map(stretch)) submaps.push_back(submap);
  return submaps;
}

/** True pose of a frame in the local map frame of a submap. */
inline mrpt::math::TPose2D trueLocalPose(const Trajectory& truth, const GridSubmap& submap,
                                         std::size_t frame) {
  return truth[frame].pose - truth[submap.first_frame].pose;
}

/** How wrong a pose is, in the axes of the frame that both are seen from. */
struct PoseError {
  double x = 0, y = 0, phi = 0;  ///< m, m, rad

  double distance() const { return std::hypot(x, y); }
};

inline PoseError poseError(const mrpt::math::TPose2D& estimated, const mrpt::math::TPose2D& truth) {
  return {estimated.x - truth.x, estimated.y - truth.y, mrpt::math::wrapToPi(estimated.phi - truth.phi)};
}

inline PoseError endError(const Trajectory& truth, const GridSubmap& submap) {
  const std::size_t end = submap.has_successor ? submap.end_frame : submap.end_frame - 1;
  return poseError(submap.end_pose.mean.asTPose(), trueLocalPose(truth, submap, end));
}

/** Length of the log in frames: simulated at `rate` Hz along the first `metres` of the world's route. */
inline SimulatedLog simulateRoute(const World& world, double metres, const OdometryModel& odometry,
                                  uint64_t seed, const LaserModel& laser = {}, double speed = 0.8,
                                  double rate = 5) {
  DriveLimits limits;
  limits.max_speed = speed;
  Path path = drive(world.route, limits, rate);
  double length = 0;
  std::size_t n = 1;
  for (; n < path.poses.size() && length < metres; ++n)
    length += std::hypot(path.poses[n].x - path.poses[n - 1].x, path.poses[n].y - path.poses[n - 1].y);
  path.poses.resize(n);
  return simulate(world, path, laser, odometry, seed);
}

}  // namespace submap_slam
