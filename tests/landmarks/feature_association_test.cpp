#include <gtest/gtest.h>
#include <submap_slam/landmarks/feature_association.h>

#include <cmath>

namespace submap_slam::landmark_mapping {
namespace {

using Kind = Origin::Kind;

TEST(Assign, TakesTheNearestFirstAndEachOnce) {
  // Measurement 1 is nearer to feature 7 than measurement 0, which then has only feature 8.
  const auto origins = assign(2, {{0, 7, 2}, {0, 8, 5}, {1, 7, 1}}, 9);
  EXPECT_EQ(origins[0].kind, Kind::kFeature);
  EXPECT_EQ(origins[0].feature, 8u);
  EXPECT_EQ(origins[1].feature, 7u);
}

TEST(Assign, LeavesOutWhatIsNeitherNearNorNew) {
  const auto origins = assign(3, {{0, 7, 12}, {1, 7, 1}, {2, 7, 2}}, 9);
  EXPECT_EQ(origins[0].kind, Kind::kAmbiguous) << "between the gates";
  EXPECT_EQ(origins[1].kind, Kind::kFeature);
  EXPECT_EQ(origins[2].kind, Kind::kAmbiguous) << "its feature is taken";
}

TEST(Assign, WithoutAPairingAMeasurementIsNew) {
  EXPECT_EQ(assign(1, {}, 9)[0].kind, Kind::kNew);
  EXPECT_TRUE(assign(0, {}, 9).empty());
}

TEST(Measure, GivesTheNormalDensity) {
  const Innovation i = measure({3, 4}, Eigen::Vector2d(9, 4).asDiagonal());
  EXPECT_NEAR(i.distance2, 1 + 4, 1e-12);
  EXPECT_NEAR(std::exp(i.logLikelihood()), std::exp(-2.5) / (2 * M_PI * 6), 1e-12);
}

}  // namespace
}  // namespace submap_slam::landmark_mapping
