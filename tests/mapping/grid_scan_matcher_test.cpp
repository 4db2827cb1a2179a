#include <gtest/gtest.h>
#include <submap_slam/mapping/grid_scan_matcher.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "synthetic_scans.h"

namespace submap_slam {
namespace {

using Eigen::Vector3d;
using mrpt::math::TPose2D;

constexpr double kFar = 100.0;
constexpr double kDegree = M_PI / 180;

/** The grid's frame: walls lie at all angles and offsets to its rows. */
const TPose2D kWorldInGrid(0.03, 0.02, 0.41);

ProbabilityGrid gridOf(const World& world, const std::vector<TPose2D>& T_world_robot, double resolution) {
  ProbabilityGridParams params;
  params.resolution = resolution;
  ProbabilityGrid grid(params);
  for (const auto& pose : T_world_robot) grid.insert(scanFrom(world, pose), kWorldInGrid + pose, kFar);
  return grid;
}

class GridMatcher : public ::testing::Test {
 protected:
  const World room = boxRoom();
  const TPose2D T_world_robot{0.12, 0.05, 0.1}, truth = kWorldInGrid + T_world_robot;
  const LaserPoints scan = scanFrom(room, T_world_robot);
  const std::vector<TPose2D> around{{0, 0, 0},         {0.3, 0.1, 0.2},    {-0.1, 0.2, -0.1},
                                    {0.2, -0.2, 0.3},  {-0.3, -0.1, 0.15}, {0.1, 0.25, -0.25},
                                    {0.4, -0.1, 0.05}, {-0.2, 0.1, 0.35}};
  const ProbabilityGrid fine = gridOf(room, around, 0.05), coarse = gridOf(room, around, 0.1);
};

TEST_F(GridMatcher, FindsThePoseFromADistance) {
  const GridScanMatcher matcher{ScanMatchingParams{}};
  for (const double sign_x : {-1.0, 1.0})
    for (const double sign_phi : {-1.0, 1.0}) {
      const TPose2D start(truth.x + sign_x * 0.1, truth.y - 0.02, truth.phi + sign_phi * 3 * kDegree);
      const MatchResult match = matcher.match(coarse, scan, start, false);
      EXPECT_LT(distance(match.pose, truth), 0.03);
      EXPECT_LT(turn(match.pose, truth), 0.3 * kDegree);
      EXPECT_GT(match.inlier_share, 0.85);
      EXPECT_GT(match.information.llt().matrixL().determinant(), 0);
    }
}

TEST_F(GridMatcher, FinerCellsFindItMoreExactly) {
  const MatchResult match = GridScanMatcher{ScanMatchingParams{}}.match(fine, scan, truth, false);
  EXPECT_LT(distance(match.pose, truth), 0.012);
  EXPECT_LT(turn(match.pose, truth), 0.2 * kDegree);
}

TEST_F(GridMatcher, TheSearchWidensTheBasin) {
  const GridScanMatcher matcher{ScanMatchingParams{}};
  const TPose2D start(truth.x + 0.2, truth.y - 0.1, truth.phi - 0.3);
  EXPECT_GT(turn(matcher.match(coarse, scan, start, false).pose, truth), 0.1);
  const MatchResult match = matcher.match(coarse, scan, start, true);
  EXPECT_LT(distance(match.pose, truth), 0.06) << "the weights pull a little";
  EXPECT_LT(turn(match.pose, truth), 0.5 * kDegree);
}

TEST_F(GridMatcher, HeadingsAreComparedAcrossTheBorder) {
  const TPose2D at(truth.x, truth.y, M_PI - 0.01);
  const LaserPoints turned = scanFrom(room, at - kWorldInGrid);
  const GridScanMatcher matcher{ScanMatchingParams{}};
  const MatchResult match = matcher.match(coarse, turned, {at.x, at.y, -M_PI + 0.03}, false);
  EXPECT_LT(turn(match.pose, at), 0.3 * kDegree);
  EXPECT_LE(std::abs(match.pose.phi), M_PI);
}

TEST_F(GridMatcher, WeightsHoldThePrediction) {
  ScanMatchingParams params;
  params.translation_weight = params.rotation_weight = 1e4;
  const TPose2D start(truth.x + 0.05, truth.y, truth.phi + kDegree);
  const MatchResult match = GridScanMatcher(params).match(coarse, scan, start, false);
  EXPECT_LT(distance(match.pose, start), 1e-5);
  EXPECT_LT(turn(match.pose, start), 1e-5);
}

TEST_F(GridMatcher, AScanOffTheMapStaysWhereItIsExpected) {
  const TPose2D far(500, -300, 1);
  const MatchResult match = GridScanMatcher{ScanMatchingParams{}}.match(coarse, scan, far, false);
  EXPECT_LT(distance(match.pose, far), 1e-9);
  EXPECT_LT(turn(match.pose, far), 1e-9);
  EXPECT_EQ(match.inlier_share, 0);
  EXPECT_TRUE(match.information.isZero());
  EXPECT_NEAR(match.cost, 0.5 * 0.9 * 0.9, 1e-9) << "1 - min_probability for every beam";
}

TEST_F(GridMatcher, GradientIsTheDerivativeOfTheCost) {
  constexpr double kStep = 1e-6;
  for (const TPose2D& pose : {TPose2D(0.13, 0.02, 0.12), TPose2D(-0.05, 0.1, -0.2)}) {
    Vector3d numeric;
    for (std::size_t k = 0; k < 3; ++k) {
      TPose2D high = pose, low = pose;
      high[k] += kStep, low[k] -= kStep;
      numeric[static_cast<Eigen::Index>(k)] = (GridScanMatcher::evaluate(coarse, scan, high).cost -
                                               GridScanMatcher::evaluate(coarse, scan, low).cost) /
                                              (2 * kStep);
    }
    const Vector3d gradient = GridScanMatcher::evaluate(coarse, scan, pose).gradient;
    EXPECT_LT((gradient - numeric).norm(), 1e-5 * numeric.norm()) << gradient.transpose();
  }
}

}  // namespace
}  // namespace submap_slam
