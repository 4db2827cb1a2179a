#include <gtest/gtest.h>
#include <submap_slam/mapping/particle_filter.h>

#include <cmath>

#include "synthetic_scans.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Drives through the room and tells the filter the true increments. */
void driveThroughRoom(ParticleFilter& filter, int steps) {
  const World room = boxRoom();
  const TPose2D step(0.1, 0, 0.03);
  TPose2D pose;
  for (int i = 0; i < steps; ++i, pose = pose + step)
    filter.step(scanFrom(room, pose), i > 0 ? std::optional<TPose2D>(step) : std::nullopt);
}

TPose2D afterDrive(int steps) {
  TPose2D pose;
  for (int i = 1; i < steps; ++i) pose = pose + TPose2D(0.1, 0, 0.03);
  return pose;
}

TEST(MotionModel, DeviationsGrowWithTheStep) {
  MotionParams p;
  p.sigma_xy = 0.01, p.sigma_xy_per_m = 0.1;
  p.sigma_phi = 0.02, p.sigma_phi_per_rad = 0.2, p.sigma_phi_per_m = 0.05;
  const Eigen::Matrix3d information = motionInformation(p, {3, 4, -0.5});
  const double xy = 0.01 + 0.1 * 5, phi = 0.02 + 0.2 * 0.5 + 0.05 * 5;
  EXPECT_NEAR(information(0, 0), 1 / (xy * xy), 1e-9);
  EXPECT_NEAR(information(1, 1), 1 / (xy * xy), 1e-9);
  EXPECT_NEAR(information(2, 2), 1 / (phi * phi), 1e-9);
  EXPECT_EQ(information(0, 1), 0);
}

TEST(ParticleFilter, StartsAtTheOriginWithAKeyScan) {
  ParticleFilter filter({}, 1);
  filter.step(scanFrom(boxRoom(), {1, 0.5, 2}), std::nullopt);
  ASSERT_EQ(filter.best().path.size(), 1u);
  EXPECT_EQ(filter.best().path[0].pose, TPose2D());
  EXPECT_TRUE(filter.best().path[0].key);
  EXPECT_FALSE(filter.best().map.empty());
}

TEST(ParticleFilter, OneHypothesisSufficesWhereTheMatchIsClear) {
  ParticleFilter filter({}, 1);
  driveThroughRoom(filter, 15);
  EXPECT_EQ(filter.size(), 1u);
  EXPECT_EQ(filter.rescues(), 0u);
  EXPECT_NEAR(filter.effectiveParticles(), 1, 1e-12);
  const TPose2D pose = filter.best().path.back().pose;
  EXPECT_LT(distance(pose, afterDrive(15)), 0.01) << pose;
  EXPECT_LT(turn(pose, afterDrive(15)), 0.005) << pose;
}

TEST(ParticleFilter, WithoutOdometryTheLastMotionGoesOn) {
  ParticleFilter filter({}, 1);
  const LaserPoints nothing;
  filter.step(nothing, std::nullopt);
  filter.step(nothing, TPose2D(0.2, 0, 0.1));
  filter.step(nothing, std::nullopt);
  const TPose2D pose = filter.best().path.back().pose, expected = TPose2D(0.2, 0, 0.1) + TPose2D(0.2, 0, 0.1);
  EXPECT_LT(distance(pose, expected), 1e-9);
  EXPECT_LT(turn(pose, expected), 1e-9);
}

TEST(ParticleFilter, KeyScansAreTakenByDistanceAndByTurn) {
  FilterParams params;
  params.keys.distance = 0.25;
  params.keys.angle = 0.15;
  const World room = boxRoom();
  ParticleFilter filter(params, 1);
  const std::vector<TPose2D> poses{{0, 0, 0},   {0.1, 0, 0},   {0.2, 0, 0},
                                   {0.3, 0, 0}, {0.3, 0, 0.1}, {0.3, 0, 0.2}};
  for (std::size_t i = 0; i < poses.size(); ++i)
    filter.step(scanFrom(room, poses[i]), i ? std::optional<TPose2D>(poses[i] - poses[i - 1]) : std::nullopt);
  std::vector<bool> keys;
  for (const auto& node : filter.best().path) keys.push_back(node.key);
  EXPECT_EQ(keys, (std::vector<bool>{true, false, false, true, false, true}));
}

TEST(ParticleFilter, ScansThatSeeNothingFollowOdometryAndRaiseNoDoubt) {
  ParticleFilter filter({}, 1);
  driveThroughRoom(filter, 15);
  const LaserPoints nothing;
  TPose2D expected = filter.best().path.back().pose;
  for (int i = 0; i < 30; ++i, expected = expected + TPose2D(0.1, 0, 0))
    filter.step(nothing, TPose2D(0.1, 0, 0));
  EXPECT_EQ(filter.size(), 1u);
  EXPECT_EQ(filter.rescues(), 0u);
  EXPECT_LT(distance(filter.best().path.back().pose, expected), 1e-9);
  EXPECT_GT(filter.best().path.back().inlier_share, 0.8f);
}

TEST(ParticleFilter, EmptyScansAreNeverKeyScans) {
  ParticleFilter filter({}, 1);
  for (int i = 0; i < 5; ++i) filter.step({}, TPose2D(1, 0, 0));
  for (const auto& node : filter.best().path) EXPECT_FALSE(node.key);
  EXPECT_TRUE(filter.best().map.empty());
}

TEST(ParticleFilter, TheClassicalFilterKeepsItsNumberOfParticles) {
  FilterParams params;
  params.fixed_particles = 7;
  ParticleFilter filter(params, 1);
  driveThroughRoom(filter, 10);
  EXPECT_EQ(filter.size(), 7u);
  EXPECT_GT(filter.effectiveParticles(), 1);
  EXPECT_LE(filter.effectiveParticles(), 7 + 1e-9);
  EXPECT_LT(distance(filter.best().path.back().pose, afterDrive(10)), 0.03);
}

TEST(ParticleFilter, TheClassicalFilterDependsOnItsSeedAlone) {
  FilterParams params;
  params.fixed_particles = 5;
  const auto endWith = [&](uint64_t seed) {
    ParticleFilter filter(params, seed);
    driveThroughRoom(filter, 8);
    return filter.best().path.back().pose;
  };
  EXPECT_EQ(endWith(1), endWith(1));
  EXPECT_NE(endWith(1), endWith(2));
}

TEST(ParticleFilter, ResamplingFollowsTheThreshold) {
  FilterParams params;
  params.fixed_particles = 5;
  params.resample_below = 0;
  ParticleFilter never(params, 1);
  driveThroughRoom(never, 10);
  EXPECT_EQ(never.resamplings(), 0u);
  params.resample_below = 1;
  ParticleFilter always(params, 1);
  driveThroughRoom(always, 10);
  EXPECT_GT(always.resamplings(), 5u);
}

/** The robot stands still while odometry claims 0.15 m, in the middle of a drive. */
TPose2D errorAfterFalseStep(int max_particles) {
  FilterParams params;
  params.max_particles = max_particles;
  const World room = boxRoom();
  ParticleFilter filter(params, 1);
  driveThroughRoom(filter, 6);
  const TPose2D here = afterDrive(6);
  filter.step(scanFrom(room, here), TPose2D(0.15, 0, 0.2));
  TPose2D pose = here;
  for (int i = 0; i < 4; ++i) {
    pose = pose + TPose2D(0.1, 0, 0.03);
    filter.step(scanFrom(room, pose), TPose2D(0.1, 0, 0.03));
  }
  return filter.best().path.back().pose - pose;
}

TEST(ParticleFilter, AFalseStepOfOdometryIsFoundOut) {
  const TPose2D error = errorAfterFalseStep(12);
  EXPECT_LT(std::hypot(error.x, error.y), 0.02);
  EXPECT_LT(std::abs(error.phi), 0.01);
}

}  // namespace
}  // namespace submap_slam
