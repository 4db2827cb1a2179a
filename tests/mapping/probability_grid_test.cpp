#include <gtest/gtest.h>
#include <submap_slam/mapping/probability_grid.h>

#include <cmath>

#include "synthetic_scans.h"

namespace submap_slam {
namespace {

constexpr double kFar = 100.0;

/** A beam from the origin along x. */
LaserPoints beamTo(float x) { return pointsAt({{x, 0.05f}}); }

/** Cell size 0.1 m, hit 0.7, miss 0.4, limits 0.1 and 0.95. */
class Grid : public ::testing::Test {
 protected:
  double at(double x) const {
    return grid.probability(static_cast<int>(std::lround(grid.columnOf(x))),
                            static_cast<int>(std::lround(grid.rowOf(0.05))));
  }

  ProbabilityGrid grid{ProbabilityGridParams{}};
};

TEST(Odds, AndBack) {
  EXPECT_DOUBLE_EQ(odds(0.75), 3);
  EXPECT_DOUBLE_EQ(odds(0.5), 1);
  EXPECT_DOUBLE_EQ(probabilityOf(3), 0.75);
  EXPECT_NEAR(probabilityOf(odds(0.37)), 0.37, 1e-15);
}

TEST_F(Grid, IsEmptyUntilSomethingIsSeen) {
  EXPECT_TRUE(grid.empty());
  grid.insert({}, {}, kFar);
  EXPECT_TRUE(grid.empty());
  EXPECT_DOUBLE_EQ(at(0), 0.1) << "what was never seen explains no beam";
  grid.insert(beamTo(1.05f), {}, kFar);
  EXPECT_FALSE(grid.empty());
}

TEST_F(Grid, OddsAreMultiplied) {
  grid.insert(beamTo(1.05f), {}, kFar);
  EXPECT_NEAR(at(1.05), 0.7, 1e-6);
  EXPECT_NEAR(at(0.55), 0.4, 1e-6);
  grid.insert(beamTo(1.05f), {}, kFar);
  EXPECT_NEAR(at(1.05), 49.0 / 58, 1e-6) << "odds (7/3)²";
  EXPECT_NEAR(at(0.55), 4.0 / 13, 1e-6) << "odds (2/3)²";
  grid.insert(beamTo(2.05f), {}, kFar);  // now the first end is passed
  EXPECT_NEAR(at(1.05), 98.0 / 125, 1e-6) << "odds (7/3)² · 2/3 = 98/27";
  EXPECT_NEAR(at(0.55), 8.0 / 35, 1e-6);
  EXPECT_NEAR(at(2.05), 0.7, 1e-6);
  EXPECT_NEAR(at(1.55), 0.4, 1e-6);
}

TEST_F(Grid, IsClamped) {
  for (int i = 0; i < 4; ++i) grid.insert(beamTo(1.05f), {}, kFar);  // (7/3)⁴ = 29.6 would be 0.967
  EXPECT_NEAR(at(1.05), 0.95, 1e-6);
  EXPECT_NEAR(at(0.55), 16.0 / 97, 1e-6) << "odds (2/3)⁴";
  for (int i = 0; i < 6; ++i) grid.insert(beamTo(1.05f), {}, kFar);
  EXPECT_NEAR(at(1.05), 0.95, 1e-6);
  EXPECT_NEAR(at(0.55), 0.1, 1e-6);
  grid.insert(beamTo(2.05f), {}, kFar);
  EXPECT_NEAR(at(1.05), 38.0 / 41, 1e-6) << "odds 19 · 2/3: what is clamped can still change";
}

TEST_F(Grid, AScanCountsOncePerCellAndHitsGoFirst) {
  const LaserPoints scan = pointsAt({{2.05f, 0.05f}, {1.05f, 0.05f}, {1.06f, 0.06f}, {1.07f, 0.05f}});
  grid.insert(scan, {}, kFar);
  EXPECT_NEAR(at(1.05), 0.7, 1e-6);
  EXPECT_NEAR(at(0.55), 0.4, 1e-6);
}

TEST_F(Grid, LongBeamsOnlyFree) {
  grid.insert(beamTo(2.05f), {}, 1.0);
  EXPECT_NEAR(at(0.55), 0.4, 1e-6);
  EXPECT_DOUBLE_EQ(at(1.55), 0.1);
  EXPECT_DOUBLE_EQ(at(2.05), 0.1);
}

TEST_F(Grid, KeepsItsContentsWhenItGrows) {
  grid.insert(beamTo(1.05f), {}, kFar);
  grid.insert(beamTo(60.05f), {-30, 0.0, 0}, kFar);
  EXPECT_NEAR(at(1.05), 14.0 / 23, 1e-6) << "odds 7/3 · 2/3";
  EXPECT_NEAR(at(30.05), 0.7, 1e-6);
  EXPECT_NEAR(at(-29.95), 0.4, 1e-6);
}

}  // namespace
}  // namespace submap_slam
