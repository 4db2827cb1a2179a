#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/simulation/path.h>

#include <cmath>
#include <limits>

namespace submap_slam {
namespace {

constexpr double kPi = 3.141592653589793;

void expectPose(const mrpt::math::TPose2D& pose, double x, double y, double phi) {
  EXPECT_NEAR(pose.x, x, 1e-9);
  EXPECT_NEAR(pose.y, y, 1e-9);
  EXPECT_NEAR(mrpt::math::wrapToPi(pose.phi - phi), 0, 1e-9);
}

TEST(Drive, GoesStraightAtFullSpeed) {
  const Path path = drive({{1, 2}, {1, 4}}, {0.5, 0.7, 0.5}, 2);
  EXPECT_DOUBLE_EQ(path.period, 0.5);
  ASSERT_EQ(path.poses.size(), 9u);  // 4 s at 2 Hz, both ends included
  for (std::size_t k = 0; k < path.poses.size(); ++k)
    expectPose(path.poses[k], 1, 2 + 0.25 * static_cast<double>(k), kPi / 2);
}

TEST(Drive, RoundsARightAngleByAnArcThatTouchesBothLegs) {
  // Legs of 2 m, radius 0.5 m at 0.5 rad/s: 1.5 m straight in 3 s, the arc in π s, 1.5 m in 3 s.
  const Path path = drive({{0, 0}, {2, 0}, {2, 2}}, {0.5, 0.5, 0.5}, 1000);
  const double speed_on_arc = 0.25;
  EXPECT_NEAR(static_cast<double>(path.poses.size() - 1) / 1000, 6 + kPi, 1.1e-3);
  expectPose(path.poses[3000], 1.5, 0, 0);
  expectPose(path.poses[3000 + 1000], 1.5 + 0.5 * std::sin(0.5), 0.5 - 0.5 * std::cos(0.5), 0.5);
  EXPECT_NEAR((path.poses[4001] - path.poses[4000]).norm(), speed_on_arc / 1000, 1e-9);
  expectPose(path.poses.back(), 2, 2 - 0.5 * (6 + kPi - static_cast<double>(path.poses.size() - 1) / 1000),
             kPi / 2);
}

TEST(Drive, SharesAShortLegBetweenTheCornersAtItsEnds) {
  // Two quarter circles of 0.2 m radius at 0.5 rad/s, with 0.2 m straight before and after.
  const Path path = drive({{0, 0}, {0.4, 0}, {0.4, -0.4}, {0.8, -0.4}}, {0.5, 0.5, 5.0}, 1000);
  const double duration = 0.4 / 0.5 + 2 * kPi;
  EXPECT_NEAR(static_cast<double>(path.poses.size() - 1) / 1000, duration, 1.1e-3);
  const auto& middle = path.poses[static_cast<std::size_t>(std::lround(500 * duration))];
  EXPECT_NEAR(middle.x, 0.4, 1e-4);
  EXPECT_NEAR(middle.y, -0.2, 1e-4);
  EXPECT_NEAR(middle.phi, -kPi / 2, 1e-3);
  EXPECT_NEAR(path.poses.back().x, 0.8, 1e-3);
  EXPECT_NEAR(path.poses.back().y, -0.4, 1e-9);
}

TEST(Drive, ShrinksTheArcWhereLegsAreShort) {
  const Path path = drive({{0, 0}, {0.4, 0}, {0.4, -0.4}}, {0.5, 0.5, 5.0}, 100);
  for (const auto& pose : path.poses) {
    EXPECT_GE(pose.x, -1e-9);
    EXPECT_LE(pose.x, 0.4 + 1e-9);
    EXPECT_GE(pose.y, -0.4 - 1e-9);
    EXPECT_LE(pose.y, 1e-9);
  }
  EXPECT_NEAR(path.poses.back().phi, -kPi / 2, 1e-2);
}

TEST(Drive, TurnsOnTheSpotWhereTheRouteReverses) {
  // 2 s out, π rad at 1 rad/s, 2 s back.
  const Path path = drive({{0, 0}, {1, 0}, {0, 0}}, {0.5, 1, 0.5}, 10);
  EXPECT_EQ(path.poses.size(), 72u);
  expectPose(path.poses[35], 1, 0, 1.5);  // turns left
  expectPose(path.poses[71], 1 - 0.5 * (7.1 - 4 - kPi + 2), 0, kPi);
}

TEST(Drive, KeepsItsLimitsAndHeadsAlongItsMotion) {
  const DriveLimits limits{0.5, 0.7, 0.5};
  const Path path = drive(roomWorld().route, limits, 10);
  for (std::size_t k = 1; k < path.poses.size(); ++k) {
    const auto step = path.poses[k] - path.poses[k - 1];
    ASSERT_LE(std::hypot(step.x, step.y), limits.max_speed * path.period + 1e-12);
    ASSERT_LE(std::abs(step.phi), limits.max_turn_rate * path.period + 1e-12);
    ASSERT_LE(std::abs(step.y), 0.004) << "lateral motion at pose " << k;
    ASSERT_LE(std::abs(path.poses[k].phi), kPi);
  }
}

TEST(Drive, RefusesImpossibleInput) {
  const WayPoints line{{0, 0}, {1, 0}};
  EXPECT_THROW(drive({{0, 0}}, {}, 5), ConfigError);
  EXPECT_THROW(drive({{0, 0}, {1, 0}, {1, 0}}, {}, 5), ConfigError);
  EXPECT_THROW(drive({{0, 0}, {1, std::numeric_limits<double>::quiet_NaN()}}, {}, 5), ConfigError);
  EXPECT_THROW(drive(line, {std::numeric_limits<double>::infinity(), 0.7, 0.5}, 5), ConfigError);
  EXPECT_THROW(drive(line, {0, 0.7, 0.5}, 5), ConfigError);
  EXPECT_THROW(drive(line, {0.5, -1, 0.5}, 5), ConfigError);
  EXPECT_THROW(drive(line, {0.5, 0.7, 0}, 5), ConfigError);
  EXPECT_THROW(drive(line, {}, 0), ConfigError);
  EXPECT_THROW(drive(line, {}, std::numeric_limits<double>::quiet_NaN()), ConfigError);
}

}  // namespace
}  // namespace submap_slam
