// Logs with something wrong in them, from scans to the joined map: the map is right, or the result says where
// it may not be.
#include <gtest/gtest.h>
#include <submap_slam/core/doubtful_ends.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../mapping/mapped_log.h"
#include "odometry_pose_graph/odometry_pose_graph.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** What became of a log. */
struct Outcome {
  GridSubmaps submaps;
  JoinedMap joined;
  std::string breaks;

  /** Largest distance of a scan of the frames [begin, end) from the truth, seen from the first of them (m).
   */
  double worst(const Trajectory& truth, std::size_t begin, std::size_t end) const {
    const Trajectory poses = trajectoryOf(submaps, joined);
    double worst = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const PoseError error = poseError(poses[k].pose - poses[begin].pose, truth[k].pose - truth[begin].pose);
      worst = std::max(worst, error.distance());
    }
    return worst;
  }
};

Outcome mapAndJoin(const std::vector<Frame>& frames) {
  Outcome outcome;
  StretchParams stretching;
  stretching.max_distance = 6;
  stretching.max_nodes = 60;
  GridMapperParams mapper;
  mapper.closing.carried = true;
  outcome.submaps = mapLog(frames, mapper, 1, stretching);
  uint32_t id = 0;
  for (const auto& submap : outcome.submaps) submap->id = id++;
  OdometryPoseGraph joiner;
  ParameterTable parameters;
  joiner.describe(parameters);
  outcome.joined = joiner.join(outcome.submaps, chainSubmaps(outcome.submaps), {});
  outcome.breaks = describeBreaks(outcome.submaps, outcome.joined.constraints);
  return outcome;
}

/** 1.3 laps around a block. */
SimulatedLog lap(const OdometryModel& odometry, double metres = 100) {
  return simulateRoute(loopWorld(), metres, odometry, 5);
}

void expectRightMap(const SimulatedLog& log) {
  const Outcome outcome = mapAndJoin(log.frames);
  EXPECT_LT(outcome.worst(log.truth, 0, log.truth.size()), 0.3);
  EXPECT_EQ(outcome.breaks, "");
}

TEST(BadOdometry, OfTheWrongScale) {
  OdometryModel odometry;
  odometry.distance_scale = odometry.turn_scale = 1.2;
  expectRightMap(lap(odometry));
}

TEST(BadOdometry, WithJumps) {
  OdometryModel odometry;
  odometry.jumps = {{20, {0.8, 0, 0}}, {50, {0, 0, 0.9}}, {80, {-1.5, 0.5, -0.5}}};
  expectRightMap(lap(odometry));
}

TEST(BadOdometry, WithGaps) {
  SimulatedLog log = lap({});
  for (std::size_t k = 0; k < log.frames.size(); ++k)
    if (k % 100 >= 80) log.frames[k].odometry.reset();
  expectRightMap(log);
}

TEST(BadOdometry, None) {
  SimulatedLog log = lap({});
  for (auto& frame : log.frames) frame.odometry.reset();
  expectRightMap(log);
}

/** The robot is switched off after the first log, carried, and goes on with the second one.
 * @param reset odometry begins anew; else it goes on as if nothing had been */
SimulatedLog restarted(SimulatedLog first, const SimulatedLog& second, bool reset) {
  const TPose2D last = *first.frames.back().odometry;
  const std::size_t frames = first.frames.size();
  for (std::size_t k = 0; k < second.frames.size(); ++k) {
    Frame frame = second.frames[k];
    frame.index = frames + k;
    frame.stamp = first.frames[frames - 1].stamp + std::chrono::milliseconds(200 * (k + 1));
    if (!reset) frame.odometry = last + *frame.odometry;
    first.frames.push_back(frame);
    first.truth.push_back({frame.stamp, second.truth[k].pose});
  }
  return first;
}

TEST(Kidnapped, ToAnotherPlaceIsReported) {
  const SimulatedLog first = lap({}, 20), second = simulateRoute(roomWorld(), 20, {}, 6);
  for (const bool reset : {false, true}) {
    const SimulatedLog log = restarted(first, second, reset);
    const Outcome outcome = mapAndJoin(log.frames);
    ASSERT_EQ(breaksOf(outcome.submaps, outcome.joined.constraints).size(), 1u) << reset;
    EXPECT_NE(outcome.breaks.find("the log has a break before submap "), std::string::npos);
    const std::size_t k = breaksOf(outcome.submaps, outcome.joined.constraints).front();
    const std::size_t frame = outcome.submaps[k]->first_frame;
    EXPECT_EQ(frame, first.frames.size());
    EXPECT_LT(outcome.worst(log.truth, 0, frame), 0.2) << "each part is right";
    EXPECT_LT(outcome.worst(log.truth, frame, log.truth.size()), 0.2);
  }
}

/** The corridors of this world look alike: the robot is found again, or the result says that it is not. */
TEST(Kidnapped, WithinTheMapIsFoundAgainOrReported) {
  const SimulatedLog first = lap({}, 40), second = lap({}, 35);
  const SimulatedLog log = restarted(first, second, false);
  const Outcome outcome = mapAndJoin(log.frames);
  if (outcome.breaks.empty()) {
    EXPECT_LT(outcome.worst(log.truth, 0, log.truth.size()), 0.3);
    return;
  }
  const auto breaks = breaksOf(outcome.submaps, outcome.joined.constraints);
  ASSERT_EQ(breaks.size(), 1u);
  const std::size_t frame = outcome.submaps[breaks.front()]->first_frame;
  EXPECT_EQ(frame, first.frames.size());
  EXPECT_LT(outcome.worst(log.truth, 0, frame), 0.3);
  EXPECT_LT(outcome.worst(log.truth, frame, log.truth.size()), 0.3);
}

}  // namespace
}  // namespace submap_slam
