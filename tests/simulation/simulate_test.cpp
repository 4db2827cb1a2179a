#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>
#include <mrpt/system/datetime.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/simulation/simulate.h>

#include <cmath>
#include <limits>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kPi = 3.141592653589793;
constexpr double kOdometryRounding =
    3e-6;  // readings are rounded to 1 µm, 1 µrad; their differences a little more

/** 4 × 4 m around the origin. */
World squareRoom() {
  return {"", {{{-2, -2}, {2, -2}}, {{2, -2}, {2, 2}}, {{2, 2}, {-2, 2}}, {{-2, 2}, {-2, -2}}}, {}};
}

LaserModel exactLaser() {
  LaserModel laser;
  laser.sigma_range = 0;
  laser.range_step = 0;
  return laser;
}

LaserModel smallLaser() {
  LaserModel laser;
  laser.beams = 5;
  return laser;
}

void expectNear(const TPose2D& actual, const TPose2D& expected, double tolerance) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(mrpt::math::wrapToPi(actual.phi - expected.phi), 0, tolerance);
}

/** Odometry of frame `to` seen from that of frame `from`. */
TPose2D increment(const SimulatedLog& log, std::size_t from, std::size_t to) {
  return *log.frames[to].odometry - *log.frames[from].odometry;
}

TPose2D trueIncrement(const SimulatedLog& log, std::size_t from, std::size_t to) {
  return log.truth[to].pose - log.truth[from].pose;
}

TEST(Laser, MeasuresFromTheSensorPoseCounterClockwise) {
  LaserModel laser = exactLaser();
  laser.beams = 3;  // −90°, 0°, 90°
  laser.sensor_pose = {0.5, 0.25, 0};
  const Path path{0.1, {{1, 0, kPi / 2}}};  // the sensor is at (0.75, 0.5) and looks along +y
  const auto scan = simulate(squareRoom(), path, laser, {}, 1).frames[0].scans[0];
  ASSERT_EQ(scan->getScanSize(), 3u);
  EXPECT_NEAR(scan->getScanRange(0), 1.25, 1e-6);
  EXPECT_NEAR(scan->getScanRange(1), 1.5, 1e-6);
  EXPECT_NEAR(scan->getScanRange(2), 2.75, 1e-6);
  EXPECT_NEAR(scan->sensorPose.x(), 0.5, 1e-12);
  EXPECT_NEAR(scan->sensorPose.y(), 0.25, 1e-12);
}

TEST(Laser, ReversesItsBeamsWhenClockwise) {
  LaserModel laser = exactLaser();
  laser.right_to_left = false;
  laser.sensor_pose = {0, 0, 0.3};
  const Path path{0.1, {{1, -0.5, 0.2}}};
  const auto clockwise = simulate(squareRoom(), path, laser, {}, 1).frames[0].scans[0];
  laser.right_to_left = true;
  const auto counter = simulate(squareRoom(), path, laser, {}, 1).frames[0].scans[0];
  EXPECT_FALSE(clockwise->rightToLeft);
  for (std::size_t i = 0; i < 181; ++i)
    ASSERT_NEAR(clockwise->getScanRange(i), counter->getScanRange(180 - i), 1e-6) << i;
}

TEST(Laser, PutsEveryEndPointOnAWallByMrptsOwnBeamAngles) {
  for (const bool right_to_left : {true, false}) {
    LaserModel laser = exactLaser();
    laser.right_to_left = right_to_left;
    laser.aperture = 4.2;
    const World world = roomWorld();
    const SimulatedLog log = simulate(world, {0.1, {{3, 4, 0.7}, {15, 10, -2}}}, laser, {}, 1);
    for (std::size_t k = 0; k < 2; ++k) {
      const auto& scan = *log.frames[k].scans[0];
      const TPose2D sensor = log.truth[k].pose + laser.sensor_pose;
      for (std::size_t i = 0; i < scan.getScanSize(); ++i) {
        if (!scan.getScanRangeValidity(i)) continue;
        const double angle = sensor.phi + scan.getScanAngle(i), range = scan.getScanRange(i);
        ASSERT_LT(world.clearance({sensor.x + range * std::cos(angle), sensor.y + range * std::sin(angle)}),
                  2e-5);
      }
    }
  }
}

TEST(Laser, MarksBeamsThatHitNothingInRange) {
  LaserModel laser = exactLaser();
  laser.beams = 3;
  laser.sensor_pose = {0, 0, 0};
  laser.max_range = 1.5;
  const auto scan = simulate(squareRoom(), {0.1, {{1, 0, 0}}}, laser, {}, 1).frames[0].scans[0];
  EXPECT_EQ(scan->maxRange, 1.5f);
  EXPECT_TRUE(scan->getScanRangeValidity(1));
  EXPECT_NEAR(scan->getScanRange(1), 1, 1e-6);
  for (const std::size_t side : {0u, 2u}) {
    EXPECT_FALSE(scan->getScanRangeValidity(side));
    EXPECT_EQ(scan->getScanRange(side), 1.5f);
  }
}

TEST(Laser, RoundsReadingsToItsStep) {
  LaserModel laser;
  laser.range_step = 0.01;
  const auto scan = simulate(squareRoom(), {0.1, {{0.3, 0.1, 0.4}}}, laser, {}, 1).frames[0].scans[0];
  for (std::size_t i = 0; i < scan->getScanSize(); ++i)
    ASSERT_NEAR(std::remainder(scan->getScanRange(i), 0.01f), 0, 1e-6) << i;
}

TEST(Frames, AreNumberedAndStampedFromTheEpoch) {
  const SimulatedLog log =
      simulate(squareRoom(), {0.1, std::vector<TPose2D>(30, {0, 0, 0})}, smallLaser(), {}, 1);
  ASSERT_EQ(log.frames.size(), 30u);
  ASSERT_EQ(log.truth.size(), 30u);
  for (std::size_t k = 0; k < 30; ++k) {
    EXPECT_EQ(log.frames[k].index, k);
    EXPECT_EQ(log.frames[k].stamp, log.truth[k].stamp);
    EXPECT_EQ(log.frames[k].stamp, log.frames[k].scans[0]->timestamp);
    EXPECT_NEAR(mrpt::Clock::toDouble(log.frames[k].stamp), 1577836800 + 0.1 * static_cast<double>(k), 1e-6);
  }
  EXPECT_EQ(mrpt::system::dateTimeToString(log.frames[0].stamp).substr(0, 19), "2020/01/01,00:00:00");
}

TEST(Odometry, StartsAtTheIdentityAndReproducesTheTruthWithoutNoise) {
  const World world = roomWorld();
  const SimulatedLog log =
      simulate(world, drive(world.route, {}, 5), smallLaser(), OdometryModel::perfect(), 1);
  expectNear(*log.frames[0].odometry, {0, 0, 0}, 0);
  for (std::size_t k = 0; k < log.frames.size(); ++k)
    expectNear(log.truth[0].pose + *log.frames[k].odometry, log.truth[k].pose, 1e-5);
}

TEST(Odometry, ScalesDistanceAndTurn) {
  OdometryModel model = OdometryModel::perfect();
  model.distance_scale = 1.1;
  model.turn_scale = 0.9;
  const SimulatedLog log = simulate(squareRoom(), {0.1, {{0, 0, 0}, {1, 0, 0.5}}}, smallLaser(), model, 1);
  expectNear(*log.frames[1].odometry, {1.1, 0, 0.45}, kOdometryRounding);
}

TEST(OdometryJump, ShiftsExactlyOneStep) {
  const World world = corridorWorld();
  const Path path = drive(world.route, {}, 5);
  OdometryModel model;
  const SimulatedLog plain = simulate(world, path, smallLaser(), model, 9);
  model.jumps = {{4.0, {0.3, -0.2, 0.5}}};  // frame 20 is at 4.0 s
  const SimulatedLog jumped = simulate(world, path, smallLaser(), model, 9);
  for (std::size_t k = 1; k < plain.frames.size(); ++k) {
    const TPose2D step = increment(plain, k - 1, k);
    const TPose2D expected = k == 20 ? step + TPose2D(0.3, -0.2, 0.5) : step;
    expectNear(increment(jumped, k - 1, k), expected, kOdometryRounding);
  }
}

TEST(WheelSlip, StretchesTheStepsInItsInterval) {
  const World world = corridorWorld();
  OdometryModel model = OdometryModel::perfect();
  model.slips = {{2.0, 3.0, 1.5}};
  const SimulatedLog log = simulate(world, drive(world.route, {}, 5), smallLaser(), model, 1);
  for (std::size_t k = 1; k < 40; ++k) {
    TPose2D expected = trueIncrement(log, k - 1, k);
    if (k > 10 && k <= 15) expected.x *= 1.5;  // steps that end at 2.2 … 3.0 s
    expectNear(increment(log, k - 1, k), expected, kOdometryRounding);
  }
}

TEST(Simulate, GivesTheNoiseOfOneSensorWhateverTheOther) {
  const World world = squareRoom();
  const Path path = drive({{-1, 0}, {1, 0}}, {}, 5);
  const SimulatedLog one = simulate(world, path, smallLaser(), {}, 5);
  LaserModel wide = smallLaser();
  wide.beams = 100;
  const SimulatedLog two = simulate(world, path, wide, {}, 5);
  const SimulatedLog three = simulate(world, path, smallLaser(), OdometryModel::perfect(), 5);
  for (std::size_t k = 0; k < path.poses.size(); ++k) {
    EXPECT_EQ(*one.frames[k].odometry, *two.frames[k].odometry);
    for (std::size_t i = 0; i < 5; ++i)
      EXPECT_EQ(one.frames[k].scans[0]->getScanRange(i), three.frames[k].scans[0]->getScanRange(i));
  }
}

TEST(Simulate, RefusesImpossibleModels) {
  const auto run = [](const LaserModel& laser, const OdometryModel& odometry) {
    return simulate(squareRoom(), {0.1, {{0, 0, 0}}}, laser, odometry, 1);
  };
  EXPECT_NO_THROW(run({}, {}));
  EXPECT_THROW(simulate(squareRoom(), {0.1, {}}, {}, {}, 1), ConfigError);
  LaserModel laser;
  laser.beams = 1;
  EXPECT_THROW(run(laser, {}), ConfigError);
  laser = {};
  laser.max_range = 0;
  EXPECT_THROW(run(laser, {}), ConfigError);
  laser = {};
  laser.sigma_range = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(run(laser, {}), ConfigError);
  OdometryModel odometry;
  odometry.along = -0.1;
  EXPECT_THROW(run({}, odometry), ConfigError);
  odometry = {};
  odometry.fixed_every = 0;
  EXPECT_THROW(run({}, odometry), ConfigError);
  odometry = {};
  odometry.slips = {{3, 2, 1.5}};
  EXPECT_THROW(run({}, odometry), ConfigError);
}

}  // namespace
}  // namespace submap_slam
