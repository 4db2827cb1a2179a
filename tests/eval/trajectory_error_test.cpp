#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <submap_slam/eval/trajectory_error.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** A wavy reference and an estimate of it in another frame with noise. */
std::vector<PosePair> noisyPairs(const TPose2D& T_reference_estimate, double noise) {
  std::mt19937_64 engine(3);
  std::normal_distribution<double> normal(0, noise);
  std::vector<PosePair> pairs;
  for (int i = 0; i < 50; ++i) {
    const TPose2D truth(0.3 * i, std::sin(0.2 * i), 0.1 * i);
    const TPose2D error(normal(engine), normal(engine), normal(engine));
    pairs.push_back({0.5 * i, truth, (TPose2D(0, 0, 0) - T_reference_estimate) + (truth + error)});
  }
  return pairs;
}

void expectSame(const TrajectoryError& a, const TrajectoryError& b) {
  EXPECT_NEAR(a.translation_m.mean, b.translation_m.mean, 1e-9);
  EXPECT_NEAR(a.translation_m.rmse, b.translation_m.rmse, 1e-9);
  EXPECT_NEAR(a.rotation_deg.mean, b.rotation_deg.mean, 1e-7);
  EXPECT_NEAR(a.rotation_deg.max, b.rotation_deg.max, 1e-7);
}

}  // namespace

TEST(AlignSe2, RecoversTheTransform) {
  const TPose2D T(3, -7, 2.8);
  const TPose2D found = alignSe2(noisyPairs(T, 0));
  EXPECT_NEAR(found.x, T.x, 1e-9);
  EXPECT_NEAR(found.y, T.y, 1e-9);
  EXPECT_NEAR(found.phi, T.phi, 1e-9);
}

TEST(AlignSe2, NoOtherTransformFitsNoisyDataBetter) {
  const auto pairs = noisyPairs({3, -7, 2.8}, 0.2);
  const auto cost = [&](const TPose2D& T_reference_estimate) {
    double sum = 0;
    for (const auto& p : pairs) {
      const TPose2D aligned = T_reference_estimate + p.estimate;
      sum += std::pow(aligned.x - p.reference.x, 2) + std::pow(aligned.y - p.reference.y, 2);
    }
    return sum;
  };
  const TPose2D best = alignSe2(pairs);
  constexpr double kStep = 1e-4;
  for (const TPose2D& step : {TPose2D(kStep, 0, 0), TPose2D(0, kStep, 0), TPose2D(0, 0, kStep)}) {
    const double ahead = cost({best.x + step.x, best.y + step.y, best.phi + step.phi});
    const double behind = cost({best.x - step.x, best.y - step.y, best.phi - step.phi});
    EXPECT_GT(ahead, cost(best));
    EXPECT_GT(behind, cost(best));
    EXPECT_NEAR(ahead, behind, 1e-8);  // the slope is zero
  }
}

TEST(AlignSe2, HeadingsDecideWherePositionsDoNot) {
  const TPose2D one = alignSe2({{0, {1, 2, 0.5}, {4, 4, -0.3}}});
  EXPECT_NEAR(one.phi, 0.8, 1e-12);
  const TPose2D mapped = one + TPose2D(4, 4, -0.3);
  EXPECT_NEAR(mapped.x, 1, 1e-12);
  EXPECT_NEAR(mapped.y, 2, 1e-12);
  const TPose2D standing = alignSe2({{0, {1, 2, 3.0}, {4, 4, 0}}, {1, {1, 2, -3.0}, {4, 4, 0}}});
  EXPECT_NEAR(std::abs(standing.phi), M_PI, 1e-9);
  EXPECT_EQ(alignSe2({}).x, 0);
}

TEST(AbsoluteTrajectoryError, HandWorked) {
  // On a line of four the estimate swings ±0.1 m to the sides in a pattern that neither turns nor shifts it.
  const std::vector<PosePair> pairs = {{0, {0, 0, 0}, {0, 0.1, 0}},
                                       {1, {1, 0, 0}, {1, -0.1, 0}},
                                       {2, {2, 0, 0}, {2, -0.1, 0}},
                                       {3, {3, 0, 0}, {3, 0.1, mrpt::DEG2RAD(4.0)}}};
  const auto error = absoluteTrajectoryError(pairs);
  EXPECT_NEAR(error.translation_m.mean, 0.1, 1e-12);
  EXPECT_NEAR(error.translation_m.rmse, 0.1, 1e-12);
  EXPECT_NEAR(error.translation_m.std, 0, 1e-12);
  EXPECT_NEAR(error.rotation_deg.mean, 1, 1e-12);
  EXPECT_NEAR(error.rotation_deg.rmse, 2, 1e-12);
  EXPECT_NEAR(error.rotation_deg.max, 4, 1e-12);
}

TEST(AbsoluteTrajectoryError, DoesNotDependOnTheGlobalFrame) {
  expectSame(absoluteTrajectoryError(noisyPairs({0, 0, 0}, 0.1)),
             absoluteTrajectoryError(noisyPairs({90, -4, -1.9}, 0.1)));
  EXPECT_GT(absoluteTrajectoryError(noisyPairs({0, 0, 0}, 0.1)).translation_m.mean, 0.05);
}

TEST(RelativePoseError, HandWorkedOverOneAndTwoSteps) {
  // The estimate slips 0.5 m ahead and turns 30° too far in its second step only.
  const double turn = mrpt::DEG2RAD(30.0);
  const std::vector<PosePair> pairs = {{0, {0, 0, 0}, {7, 7, M_PI / 2}},
                                       {1, {1, 0, 0}, {7, 8, M_PI / 2}},
                                       {2, {2, 0, 0}, {7, 9.5, M_PI / 2 + turn}},
                                       {3, {2, 0, 0.2}, {7, 9.5, M_PI / 2 + turn + 0.2}}};
  const auto one = relativePoseError(pairs);
  ASSERT_EQ(one.translation_m.count, 3u);
  EXPECT_NEAR(one.translation_m.mean, 0.5 / 3, 1e-12);
  EXPECT_NEAR(one.translation_m.max, 0.5, 1e-12);
  EXPECT_NEAR(one.rotation_deg.mean, 10, 1e-9);
  const auto two = relativePoseError(pairs, 2);
  ASSERT_EQ(two.translation_m.count, 2u);
  EXPECT_NEAR(two.translation_m.mean, 0.5, 1e-12);
  EXPECT_NEAR(two.rotation_deg.mean, 30, 1e-9);
  EXPECT_EQ(relativePoseError(pairs, 4).translation_m.count, 0u);
  EXPECT_THROW(relativePoseError(pairs, 0), std::invalid_argument);
}

TEST(RelativePoseError, DoesNotDependOnTheGlobalFrame) {
  expectSame(relativePoseError(noisyPairs({0, 0, 0}, 0.1), 3),
             relativePoseError(noisyPairs({90, -4, -1.9}, 0.1), 3));
}

TEST(CoordinateError, HandWorkedAfterAligningTheFirstPose) {
  // The estimate's frame is turned by 90° and shifted; then it is 0.3 m too far in x and 0.1 rad off, then
  // exact.
  const TPose2D shift(5, -2, M_PI / 2);
  const std::vector<PosePair> pairs = {{0, {1, 1, 0}, shift + TPose2D(1, 1, 0)},
                                       {1, {2, 1, 3.1}, shift + TPose2D(2.3, 1, -3.083185307179586)},
                                       {2, {3, 1, 0}, shift + TPose2D(3, 1, 0)}};
  const auto error = coordinateError(pairs);
  EXPECT_NEAR(error.mae_m, 0.3 / 6, 1e-12);
  EXPECT_NEAR(error.rmse_m, 0.3 / std::sqrt(6.0), 1e-12);
  EXPECT_NEAR(error.mae_rad, 0.1 / 3, 1e-12);
  EXPECT_NEAR(error.rmse_rad, 0.1 / std::sqrt(3.0), 1e-12);
  EXPECT_EQ(coordinateError({}).mae_m, 0);
}

TEST(Associate, NearestElseInterpolatedElseLeftOut) {
  const TimedTrajectory reference(
      {{1, toPose3D({1, 0, 0})}, {2, toPose3D({2, 0, 0})}, {3.25, toPose3D({3, 0, 0})}, {9, {}}});
  const TimedTrajectory estimate(
      {{1.0005, toPose3D({10, 0, 0})}, {3, toPose3D({30, 0, 0})}, {4, toPose3D({40, 0, 0.4})}});
  const auto pairs = associate(reference, estimate, 1e-3, 1);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_NEAR(pairs[0].estimate.x, 10, 1e-12);
  EXPECT_EQ(pairs[1].t, 3.25);
  EXPECT_NEAR(pairs[1].reference.x, 3, 1e-12);
  EXPECT_NEAR(pairs[1].estimate.x, 32.5, 1e-9);
  EXPECT_NEAR(pairs[1].estimate.phi, 0.1, 1e-9);
  EXPECT_EQ(associate(reference, estimate, 1e-3, 0).size(), 1u);
}

TEST(TrajectoryErrorTable, HoldsTheNumbers) {
  const auto pairs = noisyPairs({0, 0, 0}, 0);
  const auto table = formatTable(absoluteTrajectoryError(pairs), relativePoseError(pairs));
  EXPECT_THAT(table, testing::HasSubstr("absolute, position (m)"));
  EXPECT_THAT(table, testing::HasSubstr("0.0000"));
}

}  // namespace submap_slam
