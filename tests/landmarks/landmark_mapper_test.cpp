/** Where landmark submaps begin and end, and what is in them. */
#include <gtest/gtest.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/landmarks/landmark_mapper.h>
#include <Eigen/Core>

#include <cmath>

#include "simulated_drive.h"

namespace submap_slam::testing {
namespace {

LandmarkMapperParams withMostFeatures(int features) {
  LandmarkMapperParams params;
  params.closing.max_features = features;
  return params;
}

std::size_t framesOf(const LandmarkSubmaps& submaps) {
  std::size_t frames = 0;
  for (const auto& submap : submaps) frames += submap->nodes.size();
  return frames;
}

TEST(LandmarkMapper, SubmapsOfAStretchHangTogether) {
  const Drive drive = simulateDrive({});
  const auto submaps = LandmarkMapper(withMostFeatures(8), 1).map(drive.stretch);
  ASSERT_GE(submaps.size(), 2u);
  EXPECT_EQ(framesOf(submaps), drive.stretch.frames.size()) << "every frame is in one of them";
  mrpt::math::TPose2D end;
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    const LandmarkSubmap& submap = *submaps[k];
    requireUsable(submap);
    EXPECT_EQ(submap.nodes.front().pose, mrpt::math::TPose2D());
    EXPECT_EQ(submap.timestamp, submap.nodes.front().stamp);
    if (k + 1 < submaps.size()) {
      EXPECT_EQ(submap.end_stamp, submaps[k + 1]->timestamp);
    }
    EXPECT_TRUE(submap.ids_known);
    end = end + submap.end_pose;
  }
  EXPECT_NEAR(end.x, drive.path.back().x, 0.5);
  EXPECT_NEAR(end.y, drive.path.back().y, 0.5);
}

TEST(LandmarkMapper, AStretchWithASuccessorEndsWhereThatBegins) {
  Drive drive = simulateDrive({});
  drive.stretch.last = false;
  drive.stretch.frames.back().landmark_scans[0].measurements = {{5, 0, 777}};  // of the next submap
  LandmarkMapperParams params = withMostFeatures(1000);
  params.closing.max_pose_sigma = 1e9;
  const auto submaps = LandmarkMapper(params, 1).map(drive.stretch);
  ASSERT_EQ(submaps.size(), 1u);
  EXPECT_EQ(submaps[0]->nodes.size(), drive.stretch.frames.size() - 1);
  EXPECT_EQ(submaps[0]->end_stamp, drive.stretch.frames.back().stamp);
  for (const auto& feature : submaps[0]->features) EXPECT_NE(feature.id, 777u);
}

TEST(LandmarkMapper, GivesTheSameForTheSameSeed) {
  const Drive drive = simulateDrive({});
  LandmarkMapperParams params;
  params.method = "rbpf";
  const auto a = LandmarkMapper(params, 1).map(drive.stretch),
             b = LandmarkMapper(params, 1).map(drive.stretch),
             c = LandmarkMapper(params, 2).map(drive.stretch);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a[0]->end_pose, b[0]->end_pose);
  EXPECT_EQ(a[0]->covariance, b[0]->covariance);
  EXPECT_FALSE(a[0]->end_pose == c[0]->end_pose);
}

TEST(LandmarkMapper, ARobotThatStandsStillStaysInOneUsableSubmap) {
  DriveOptions options;
  options.step_m = 0;
  options.frames = 600;  // two minutes
  for (const char* method : {"ekf", "rbpf"}) {
    LandmarkMapperParams params = withMostFeatures(3);
    params.method = method;
    const auto submaps = LandmarkMapper(params, 1).map(simulateDrive(options).stretch);
    ASSERT_EQ(submaps.size(), 1u) << method;
    EXPECT_NO_THROW(requireUsable(*submaps[0])) << method;
    EXPECT_EQ(submaps[0]->end_pose, mrpt::math::TPose2D()) << method;
  }
}

TEST(LandmarkMapper, AnUncertainPoseClosesASubmap) {
  DriveOptions options;
  options.sigma_xy = 0.3;
  Drive drive = simulateDrive(options);
  for (auto& frame : drive.stretch.frames) frame.landmark_scans[0].measurements.clear();
  LandmarkMapperParams params;
  params.closing.max_pose_sigma = 5;  // of 0.1 m, as nothing is seen: 0.5 m or three steps
  const auto submaps = LandmarkMapper(params, 1).map(drive.stretch);
  EXPECT_GT(submaps.size(), 5u);
  EXPECT_LT(submaps.size(), 30u);
  for (const auto& submap : submaps) {
    EXPECT_NO_THROW(requireUsable(*submap)) << "without features";
    EXPECT_TRUE(submap->ids_known) << "nothing seen has no id";
  }
}

TEST(LandmarkMapper, GoesOnWithoutOdometry) {
  Drive drive = simulateDrive({});
  for (std::size_t k = 10; k < 13; ++k) drive.stretch.frames[k].odometry.reset();
  LandmarkMapperParams params = withMostFeatures(1000);
  params.closing.max_pose_sigma = 1e9;
  params.closing.depleted_scans = 1000;
  const auto submaps = LandmarkMapper(params, 1).map(drive.stretch);
  EXPECT_NEAR(submaps.back()->end_pose.x, drive.path.back().x, 0.5);
}

/** The frames of a stretch in two, as a grid mapper would cut them. */
std::vector<GridSubmap::Ptr> twoGrids(const Stretch& stretch, std::size_t second) {
  std::vector<GridSubmap::Ptr> grids{GridSubmap::Create(), GridSubmap::Create()};
  grids[0]->nodes.resize(second - stretch.warm_up);
  grids[0]->has_successor = true;
  grids[1]->nodes.resize(stretch.warm_up + stretch.ownFrames() - second);
  grids[1]->has_successor = !stretch.last;
  return grids;
}

TEST(LandmarkMapper, SharesTheFramesOfGrids) {
  for (const bool last : {false, true}) {
    Drive drive = simulateDrive({});
    const auto& frames = drive.stretch.frames;
    drive.stretch.warm_up = 3;
    drive.stretch.last = last;
    const std::size_t half = frames.size() / 2;
    const auto grids = twoGrids(drive.stretch, half);
    const auto submaps = LandmarkMapper({}, 1).mapBeside(grids, drive.stretch);
    ASSERT_EQ(submaps.size(), 2u);
    for (std::size_t g = 0; g < 2; ++g) EXPECT_EQ(submaps[g]->nodes.size(), grids[g]->nodes.size());
    EXPECT_EQ(submaps[0]->timestamp, frames[3].stamp);
    EXPECT_EQ(submaps[0]->end_stamp, frames[half].stamp);
    EXPECT_EQ(submaps[1]->timestamp, frames[half].stamp);
    EXPECT_EQ(submaps[1]->end_stamp, frames.back().stamp);
    const auto wanted = drive.path[half] - drive.path[3];
    EXPECT_NEAR(submaps[0]->end_pose.x, wanted.x, 0.3);
    EXPECT_NEAR(submaps[0]->end_pose.y, wanted.y, 0.3);
  }
}

double worstError(const Stretch& stretch, const std::vector<mrpt::math::TPose2D>& path) {
  double worst = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto wanted = path[i] - path[0], found = *stretch.frames[i].odometry - *stretch.frames[0].odometry;
    worst = std::max(worst, std::hypot(found.x - wanted.x, found.y - wanted.y));
  }
  return worst;
}

TEST(LandmarkMapper, CorrectsOdometryOfAllFrames) {
  for (const bool last : {false, true}) {
    Drive drive = simulateDrive({});
    drive.stretch.last = last;
    drive.stretch.warm_up = 3;
    mrpt::math::TPose2D drift;  // to the side
    for (Frame& frame : drive.stretch.frames) {
      drift.y += 0.05;
      frame.odometry = *frame.odometry + drift;
    }
    const Stretch corrected = LandmarkMapper(withMostFeatures(8), 1).withCorrectedOdometry(drive.stretch);
    EXPECT_EQ(corrected.warm_up, 3u);
    EXPECT_EQ(corrected.last, last);
    EXPECT_GT(worstError(drive.stretch, drive.path), 1.5);
    EXPECT_LT(worstError(corrected, drive.path), 0.5);
  }
}

TEST(LandmarkMapper, InventsNoOdometry) {
  Drive drive = simulateDrive({});
  drive.stretch.frames[10].odometry.reset();
  const Stretch corrected = LandmarkMapper({}, 1).withCorrectedOdometry(drive.stretch);
  for (std::size_t i = 0; i < corrected.frames.size(); ++i)
    EXPECT_EQ(corrected.frames[i].odometry.has_value(), i != 10);
  for (Frame& frame : drive.stretch.frames) frame.odometry.reset();
  for (const Frame& frame : LandmarkMapper({}, 1).withCorrectedOdometry(drive.stretch).frames)
    EXPECT_FALSE(frame.odometry);
}

TEST(LandmarkMapper, RefusesGatesThatContradict) {
  LandmarkMapperParams params;
  params.association.new_gate = 1;
  EXPECT_THROW(LandmarkMapper(params, 1), ConfigError);
}

}  // namespace
}  // namespace submap_slam::testing
