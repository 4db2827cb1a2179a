#pragma once

#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/serialization/CSerializable.h>
#include <submap_slam/mapping/grid_mapper.h>
#include <submap_slam/mapping/stretch_splitter.h>
#include <submap_slam/simulation/simulate.h>

#include <cmath>
#include <random>
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

/** All submaps as they are written to a file. */
inline std::vector<uint8_t> bytesOf(const GridSubmaps& submaps) {
  std::vector<uint8_t> bytes;
  for (const auto& submap : submaps) {
    std::vector<uint8_t> own;
    mrpt::serialization::ObjectToOctetVector(submap.get(), own);
    bytes.insert(bytes.end(), own.begin(), own.end());
  }
  return bytes;
}

/** Every frame in exactly one submap, linked to the next. */
inline void expectConsistent(const GridSubmaps& submaps, std::size_t frames) {
  uint64_t next = 0;
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    const GridSubmap& s = *submaps[k];
    EXPECT_EQ(s.first_frame, next);
    EXPECT_EQ(s.end_frame - s.first_frame, s.nodes.size());
    EXPECT_EQ(s.has_successor, k + 1 < submaps.size());
    EXPECT_EQ(s.nodes.front().pose, mrpt::math::TPose2D()) << "the local map frame is the first node";
    EXPECT_TRUE(s.nodes.front().isKey());
    next = s.end_frame;
  }
  EXPECT_EQ(next, frames);
}

/** Noise instead of the scans of frames [begin, end): the robot is carried through a crowd. */
inline void scrambleScans(std::vector<Frame>& frames, std::size_t begin, std::size_t end) {
  std::mt19937_64 random(1);
  for (std::size_t i = begin; i < end; ++i) {
    auto scan = mrpt::obs::CObservation2DRangeScan::Create(*frames[i].scans[0]);
    for (std::size_t b = 0; b < scan->getScanSize(); ++b)
      scan->setScanRange(b, 0.3f + 0.02f * static_cast<float>(random() % 500));
    frames[i].scans = {scan};
  }
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
