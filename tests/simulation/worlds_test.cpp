#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/simulation/path.h>
#include <submap_slam/simulation/scenario.h>
#include <submap_slam/simulation/world.h>

#include <cmath>
#include <limits>

namespace submap_slam {
namespace {

using mrpt::math::TPoint2D;

constexpr double kPi = 3.141592653589793;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Raycast, HitsASquareAtTheDistancesOfElementaryGeometry) {
  const World square{"square", {{{0, 0}, {4, 0}}, {{4, 0}, {4, 4}}, {{4, 4}, {0, 4}}, {{0, 4}, {0, 0}}}, {}};
  const TPoint2D origin{1, 2};
  EXPECT_DOUBLE_EQ(square.raycast(origin, 0), 3);
  EXPECT_DOUBLE_EQ(square.raycast(origin, kPi), 1);
  EXPECT_NEAR(square.raycast(origin, kPi / 2), 2, 1e-14);
  EXPECT_NEAR(square.raycast(origin, -kPi / 4), 2 * std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(square.raycast(origin, std::atan2(1, 3)), std::sqrt(10.0), 1e-14);
}

TEST(Raycast, ReturnsTheNearestOfSeveralWallsInAnyOrder) {
  const World walls{"", {{{3, -1}, {3, 1}}, {{2, -1}, {2, 1}}, {{5, -1}, {5, 1}}}, {}};
  EXPECT_DOUBLE_EQ(walls.raycast({0, 0}, 0), 2);
  EXPECT_DOUBLE_EQ(walls.raycast({4, 0}, 0), 1);
  EXPECT_DOUBLE_EQ(walls.raycast({4, 0}, kPi), 1);
}

TEST(Raycast, HitsASlantedWallFromBothSides) {
  const World slanted{"", {{{0, 2}, {2, 0}}}, {}};
  EXPECT_NEAR(slanted.raycast({0, 0}, kPi / 4), std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(slanted.raycast({2, 2}, -3 * kPi / 4), std::sqrt(2.0), 1e-14);
}

TEST(Raycast, MissesWhatIsBehindBesideOrEdgeOn) {
  const World wall{"", {{{2, 1}, {2, 3}}}, {}};
  EXPECT_EQ(wall.raycast({0, 2}, kPi), kInfinity);
  EXPECT_EQ(wall.raycast({0, 0.999}, 0), kInfinity);
  EXPECT_EQ(wall.raycast({0, 3.001}, 0), kInfinity);
  EXPECT_EQ((World{"", {{{1, 0}, {2, 0}}}, {}}.raycast({0, 0}, 0)), kInfinity);
  EXPECT_EQ(World{}.raycast({0, 0}, 0), kInfinity);
}

TEST(Raycast, DoesNotSlipThroughTheCornersOfAPolygon) {
  World ring;
  constexpr int kCorners = 97;
  for (int i = 0; i < kCorners; ++i) {
    const double a = 2 * kPi * i / kCorners, b = 2 * kPi * (i + 1) / kCorners;
    ring.walls.push_back({{std::cos(a), std::sin(a)}, {std::cos(b), std::sin(b)}});
  }
  for (int i = 0; i < kCorners; ++i) EXPECT_NEAR(ring.raycast({0, 0}, 2 * kPi * i / kCorners), 1, 1e-12) << i;
}

TEST(Clearance, IsTheDistanceToTheNearestPointOfAnyWall) {
  const World wall{"", {{{0, 0}, {2, 0}}, {{10, 0}, {10, 5}}}, {}};
  EXPECT_DOUBLE_EQ(wall.clearance({1, -3}), 3);
  EXPECT_DOUBLE_EQ(wall.clearance({-3, 4}), 5);
  EXPECT_DOUBLE_EQ(wall.clearance({9, 6}), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(wall.clearance({1.5, 0}), 0);
  EXPECT_EQ(World{}.clearance({0, 0}), kInfinity);
}

TEST(MakeWorld, KnowsItsNamesAndListsThemForAnyOther) {
  for (const std::string& name : worldNames()) EXPECT_EQ(makeWorld(name).name, name);
  try {
    makeWorld("moon");
    FAIL() << "an unknown world was made";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(testing::HasSubstr("moon"), testing::HasSubstr("periodic_corridor")));
  }
}

TEST(PeriodicCorridor, LooksTheSameOnePitchFurtherWhileNoEndIsInView) {
  const World world = periodicCorridorWorld();
  for (double angle = 0.3; angle < kPi - 0.3; angle += 0.01) {
    EXPECT_NEAR(world.raycast({18, 1.1}, angle), world.raycast({20.5, 1.1}, angle), 1e-9) << angle;
    EXPECT_NEAR(world.raycast({18, 1.1}, -angle), world.raycast({20.5, 1.1}, -angle), 1e-9) << angle;
  }
}

TEST(SymmetricRooms, DifferOnlyInTheSixth) {
  const World world = symmetricRoomsWorld();
  const auto differs = [&](int room, int other) {
    for (double angle = 0.6; angle < kPi - 0.6; angle += 0.01) {
      const double range = world.raycast({4.0 * room + 2, 3}, angle);
      if (std::abs(range - world.raycast({4.0 * other + 2, 3}, angle)) > 0.01) return true;
    }
    return false;
  };
  for (const int other : {1, 2, 3, 4, 6}) EXPECT_FALSE(differs(1, other)) << other;
  EXPECT_TRUE(differs(1, 5));
}

constexpr double kLongestFloor = 100;  // m

class EveryWorld : public testing::TestWithParam<std::string> {
 protected:
  const World world = makeWorld(GetParam());
  const Path path = drive(world.route, DriveLimits{}, 5);
};

TEST_P(EveryWorld, HasOnlyWallsWithLength) {
  for (const Wall& wall : world.walls) EXPECT_GT((wall.b - wall.a).norm(), 0.05);
}

TEST_P(EveryWorld, KeepsItsPathClearOfWalls) {
  for (const auto& pose : path.poses) ASSERT_GE(world.clearance({pose.x, pose.y}), 0.3) << pose;
}

TEST_P(EveryWorld, IsClosedAroundItsPath) {
  for (std::size_t i = 0; i < path.poses.size(); i += 5)
    for (int degree = 0; degree < 360; ++degree)
      ASSERT_LT(world.raycast({path.poses[i].x, path.poses[i].y}, degree * kPi / 180), kLongestFloor)
          << path.poses[i];
}

TEST_P(EveryWorld, ShowsTheLaserSomethingWithinItsRange) {
  const double range = makeScenario(GetParam()).laser.max_range;
  int rays = 0, hits = 0;
  for (std::size_t i = 0; i < path.poses.size(); i += 5)
    for (int degree = 0; degree < 360; ++degree, ++rays)
      hits += world.raycast({path.poses[i].x, path.poses[i].y}, degree * kPi / 180) < range;
  EXPECT_GT(hits, 0.9 * rays);
}

INSTANTIATE_TEST_SUITE_P(Worlds, EveryWorld, testing::ValuesIn(worldNames()),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace submap_slam
