#include <gtest/gtest.h>
#include <submap_slam/mapping/scan_matcher.h>

#include <cmath>

#include "synthetic_scans.h"

namespace submap_slam {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using mrpt::math::TPose2D;

constexpr double kSearchRadius = 0.3;

SurfelMap mapOf(const World& world, const std::vector<TPose2D>& poses) {
  SurfelMap map{SurfelMapParams{}};
  for (const auto& pose : poses) map.insert(scanFrom(world, pose), pose);
  return map;
}

PosePrior prior(const TPose2D& mean, double sigma_m, double sigma_rad) {
  const Vector3d sigma(sigma_m, sigma_m, sigma_rad);
  return {mean, sigma.array().square().inverse().matrix().asDiagonal()};
}

TPose2D displaced(const TPose2D& pose, int axis, double h) {
  TPose2D out = pose;
  out[static_cast<std::size_t>(axis)] += h;
  return out;
}

class Matcher : public ::testing::Test {
 protected:
  const World room = boxRoom();
  const SurfelMap map = mapOf(room, {{0, 0, 0}, {0.3, 0.1, 0.2}});
  const ScanMatcher matcher{MatcherParams{}, kSearchRadius};
};

/** A scan of one beam. */
LaserPoints only(const LaserPoint& point) { return pointsAt({point}); }

TEST(ScanMatcher, TheOtherFaceOfAWallIsNoMatch) {
  SurfelMap map{SurfelMapParams{}};
  LaserPoints wall = wallPoints(-1, 1, 1, 1);
  for (auto& p : wall.points) p.normal_y = -1;
  map.insert(wall, {});
  const ScanMatcher matcher(MatcherParams{}, kSearchRadius);
  EXPECT_EQ(matcher.evaluate(map, wall, {}).inliers, wall.points.size());
  for (auto& p : wall.points) p.normal_y = 1;
  const auto behind = matcher.evaluate(map, wall, {0, 0.1, 0});
  EXPECT_EQ(behind.inliers, 0u);
  EXPECT_TRUE(behind.gradient.isZero());
}

TEST_F(Matcher, GradientIsTheDerivativeOfTheCost) {
  constexpr double kStep = 1e-6;
  const TPose2D pose(0.13, 0.02, 0.12);
  for (const double softness : {1.0, 3.0}) {
    std::size_t compared = 0;
    for (const auto& point : scanFrom(room, {0.1, 0.05, 0.1}).points) {
      const LaserPoints beam = only(point);
      const auto nearest = [&](const TPose2D& at) {
        const auto p =
            at.composePoint(mrpt::math::TPoint2D(static_cast<double>(point.x), static_cast<double>(point.y)));
        return map.nearest(p.x, p.y);
      };
      const Surfel* surfel = nearest(pose);
      Vector3d numeric;
      bool smooth = true;  // no step across the border of a cell
      for (int k = 0; k < 3; ++k) {
        const TPose2D high = displaced(pose, k, kStep), low = displaced(pose, k, -kStep);
        smooth = smooth && nearest(high) == surfel && nearest(low) == surfel;
        numeric[k] = (matcher.evaluate(map, beam, high, softness).cost -
                      matcher.evaluate(map, beam, low, softness).cost) /
                     (2 * kStep);
      }
      if (!smooth) continue;
      ++compared;
      const Vector3d gradient = matcher.evaluate(map, beam, pose, softness).gradient;
      EXPECT_LT((gradient - numeric).norm(), 1e-4 * numeric.norm() + 1e-5) << gradient.transpose();
    }
    EXPECT_GT(compared, 300u);
  }
}

TEST_F(Matcher, HessianIsTheDerivativeOfTheGradientWhereAllBeamsFit) {
  const LaserPoints scan = scanFrom(endlessCorridor(), {});
  SurfelMap own{SurfelMapParams{}};
  own.insert(scan, {});
  const Matrix3d hessian = matcher.evaluate(own, scan, {}).hessian;
  Matrix3d numeric;
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 3; ++k)
    numeric.col(k) = (matcher.evaluate(own, scan, displaced({}, k, kStep)).gradient -
                      matcher.evaluate(own, scan, displaced({}, k, -kStep)).gradient) /
                     (2 * kStep);
  EXPECT_LT((hessian - numeric).norm(), 0.01 * hessian.norm()) << hessian << "\n\n" << numeric;
}

TEST_F(Matcher, CostOfAScanOffTheMapIsThatOfTheSearchRadius) {
  const LaserPoints scan = scanFrom(room, {});
  const auto evaluation = matcher.evaluate(map, scan, {500, 0, 0});
  // ½ c² log(1 + (0.3 / 0.05)² / c²) with c = 1
  EXPECT_NEAR(evaluation.cost, 0.5 * std::log(37.0) * static_cast<double>(scan.points.size()), 1e-6);
  EXPECT_EQ(evaluation.gradient, Vector3d::Zero());
  EXPECT_EQ(evaluation.inliers, 0u);
}

TEST_F(Matcher, RecoversKnownDisplacements) {
  for (const TPose2D& truth :
       {TPose2D{0.1, -0.05, 0.03}, {-0.12, 0.1, -0.08}, {0.3, 0.2, 0.15}, {0, 0, -0.2}}) {
    const MatchResult match = matcher.match(map, scanFrom(room, truth), prior({}, 1.0, 1.0));
    EXPECT_LT(distance(match.pose, truth), 0.005) << match.pose;
    EXPECT_LT(turn(match.pose, truth), 0.002) << match.pose;
    EXPECT_GT(match.inlier_share, 0.9);
  }
}

TEST_F(Matcher, HeadingsMeetAcrossTheWrap) {
  const TPose2D truth(0.05, 0, -M_PI + 0.03);
  const MatchResult match = matcher.match(map, scanFrom(room, truth), prior({0, 0, M_PI - 0.03}, 0.1, 0.2));
  EXPECT_LT(distance(match.pose, truth), 0.005) << match.pose;
  EXPECT_LT(turn(match.pose, truth), 0.002) << match.pose;
}

TEST_F(Matcher, ATightPriorWins) {
  const MatchResult match = matcher.match(map, scanFrom(room, {0.1, 0, 0.05}), prior({}, 1e-6, 1e-6));
  EXPECT_LT(distance(match.pose, {}), 1e-4);
  EXPECT_LT(turn(match.pose, {}), 1e-4);
}

TEST_F(Matcher, CostAtTheResultIsScanTermPlusPriorTerm) {
  const LaserPoints scan = scanFrom(room, {0.1, 0, 0.05});
  const PosePrior tight = prior({}, 0.02, 0.02);
  const MatchResult match = matcher.match(map, scan, tight);
  const Vector3d d(match.pose.x, match.pose.y, match.pose.phi);
  const auto evaluation = matcher.evaluate(map, scan, match.pose);
  EXPECT_NEAR(match.cost, evaluation.cost + 0.5 * d.dot(tight.information * d), 1e-6 * match.cost);
  EXPECT_LT((match.information - evaluation.hessian).norm(), 1e-6 * evaluation.hessian.norm());
  EXPECT_LE(match.cost, matcher.evaluate(map, scan, {}).cost);
}

TEST_F(Matcher, ThePriorHoldsTheFreeDirectionOfACorridor) {
  const World corridor = endlessCorridor();
  const SurfelMap walls = mapOf(corridor, {{0, 0, 0}, {0.4, 0, 0}});
  const MatchResult match =
      matcher.match(walls, scanFrom(corridor, {0.2, 0.07, 0.04}), prior({0.25, 0, 0}, 0.1, 0.1));
  EXPECT_NEAR(match.pose.x, 0.25, 2e-3);
  EXPECT_NEAR(match.pose.y, 0.07, 3e-3);
  EXPECT_NEAR(match.pose.phi, 0.04, 2e-3);
  EXPECT_LT(match.information(0, 0), 1e-3 * match.information(1, 1));
}

TEST_F(Matcher, AnEmptyScanLeavesThePrior) {
  const MatchResult match = matcher.match(map, LaserPoints{}, prior({1, 2, 3}, 0.1, 0.1), {1.1, 2, 3});
  EXPECT_LT(distance(match.pose, {1, 2, 3}), 1e-3);
  EXPECT_EQ(match.inlier_share, 0);
  EXPECT_EQ(match.information, Matrix3d::Zero());
}

TEST_F(Matcher, WithoutAnyInformationThePoseStaysFinite) {
  const MatchResult match = matcher.match(map, LaserPoints{}, PosePrior{{1, 2, 3}, Matrix3d::Zero()});
  EXPECT_LT(distance(match.pose, {1, 2, 3}), 1e-6);
}

TEST_F(Matcher, WithoutOverlapThePriorStays) {
  const MatchResult match = matcher.match(map, scanFrom(room, {}), prior({100, 0, 0}, 0.1, 0.1));
  EXPECT_LT(distance(match.pose, {100, 0, 0}), 1e-6);
  EXPECT_EQ(match.inlier_share, 0);
  const SurfelMap nothing{SurfelMapParams{}};
  EXPECT_LT(distance(matcher.match(nothing, scanFrom(room, {}), prior({1, 0, 0}, 0.1, 0.1)).pose, {1, 0, 0}),
            1e-6);
}

TEST_F(Matcher, InlierShareIsThatOfTheBeamsThatTheMapExplains) {
  LaserPoints scan = scanFrom(room, {});
  const std::size_t known = scan.points.size();
  for (std::size_t k = 0; k < known; ++k) scan.points.push_back({0.5f, 0.5f});  // an obstacle the map lacks
  scan.sweeps[0].end = scan.points.size();
  EXPECT_NEAR(matcher.match(map, scan, prior({}, 0.1, 0.1)).inlier_share, 0.5, 0.02);
}

}  // namespace
}  // namespace submap_slam
