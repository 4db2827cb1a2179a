#include <gtest/gtest.h>
#include <submap_slam/landmarks/feature_association.h>

#include <cmath>

namespace submap_slam::landmark_mapping {
namespace {

using Kind = Origin::Kind;

TEST(Assign, TakesTheNearestFirstAndEachOnce) {
  // Measurement 1 is nearer to feature 7 than measurement 0, which then has only feature 8.
  const auto origins = assign(std::vector<Origin>(2), {{0, 7, 2}, {0, 8, 5}, {1, 7, 1}}, 9);
  EXPECT_EQ(origins[0].kind, Kind::kFeature);
  EXPECT_EQ(origins[0].feature, 8u);
  EXPECT_EQ(origins[1].feature, 7u);
}

TEST(Assign, LeavesOutWhatIsNeitherNearNorNew) {
  const auto origins = assign(std::vector<Origin>(3), {{0, 7, 12}, {1, 7, 1}, {2, 7, 2}}, 9);
  EXPECT_EQ(origins[0].kind, Kind::kAmbiguous) << "between the gates";
  EXPECT_EQ(origins[1].kind, Kind::kFeature);
  EXPECT_EQ(origins[2].kind, Kind::kAmbiguous) << "its feature is taken";
}

TEST(Assign, WithoutAPairingAMeasurementIsNew) {
  EXPECT_EQ(assign(std::vector<Origin>(1), {}, 9)[0].kind, Kind::kNew);
  EXPECT_TRUE(assign(std::vector<Origin>(0), {}, 9).empty());
}

TEST(Unrivalled, AreMatchesOfWhichNeitherSideHasAnother) {
  const auto origins = unrivalled(5, {{0, 1, 2}, {1, 2, 1}, {1, 3, 8}, {2, 4, 1}, {3, 4, 7}, {4, 5, 10}}, 9);
  EXPECT_EQ(origins[0].kind, Kind::kFeature);
  EXPECT_EQ(origins[0].feature, 1u);
  for (std::size_t m = 1; m < 5; ++m) EXPECT_EQ(origins[m].kind, Kind::kNew) << m;
}

TEST(Assign, KeepsWhatIsMatchedAlready) {
  const std::vector<Origin> before{{Kind::kFeature, 7}, {}, {}};
  const auto origins = assign(before, {{1, 7, 1}, {2, 7, 1}, {2, 8, 3}}, 9);
  EXPECT_EQ(origins[0].feature, 7u);
  EXPECT_EQ(origins[1].kind, Kind::kAmbiguous) << "its feature is taken";
  EXPECT_EQ(origins[2].feature, 8u);
  EXPECT_EQ(newMatches(before, origins), (std::vector<std::pair<std::size_t, std::size_t>>{{2, 8}}));
}

TEST(Measure, GivesTheNormalDensity) {
  const Innovation i = measure({3, 4}, Eigen::Vector2d(9, 4).asDiagonal());
  EXPECT_NEAR(i.distance2, 1 + 4, 1e-12);
  EXPECT_NEAR(std::exp(i.logLikelihood()), std::exp(-2.5) / (2 * M_PI * 6), 1e-12);
}

}  // namespace
}  // namespace submap_slam::landmark_mapping
