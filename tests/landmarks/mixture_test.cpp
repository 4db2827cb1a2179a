/** The mixture of particles as one Gaussian. */
#include <gmock/gmock.h>
#include <submap_slam/landmarks/mixture.h>

#include <cmath>

namespace submap_slam::landmark_mapping {
namespace {

Feature feature(uint32_t id, double x, double y, double variance, uint32_t hits = 5) {
  Feature f;
  f.id = id;
  f.mean << x, y;
  f.covariance = Eigen::Matrix2d::Identity() * variance;
  f.hits = hits;
  return f;
}

MixtureComponent component(double weight, const Pose& pose, const std::vector<Feature>& features) {
  return {weight, pose, Eigen::Matrix3d::Zero(), features, {}};
}

LandmarkEstimate gaussianOf(const std::vector<MixtureComponent>& components, bool corrected = false,
                            int min_hits = 1) {
  std::vector<std::size_t> kept;
  return toGaussian(components, {min_hits, 0.3, corrected}, kept);
}

TEST(ToGaussian, HasTheMomentsOfAHandWorkedMixture) {
  // Weights 3/4 and 1/4; x: 0 and 4, feature's x: 10 and 14. Means 1 and 11; variances and covariance
  // 3/4·1 + 1/4·9 = 3; the feature's own variance is 0.2·3/4 + 0.6/4 = 0.3, the pose's 0.04/4 = 0.01.
  auto second = component(0.25, {4, 0, 0}, {feature(1, 14, 0, 0.6)});
  second.pose_covariance = Eigen::Vector3d(0.04, 0.04, 0.04).asDiagonal();
  const auto estimate = gaussianOf({component(0.75, {0, 0, 0}, {feature(1, 10, 0, 0.2)}), second});
  EXPECT_NEAR(estimate.pose[0], 1, 1e-12);
  ASSERT_EQ(estimate.features.size(), 1u);
  EXPECT_NEAR(estimate.features[0].x, 11, 1e-12);
  EXPECT_NEAR(estimate.covariance(0, 0), 3.01, 1e-12);
  EXPECT_NEAR(estimate.covariance(3, 3), 3.3, 1e-12);
  EXPECT_NEAR(estimate.covariance(0, 3), 3, 1e-12);
  EXPECT_NEAR(estimate.covariance(1, 1), 0.01, 1e-12);
  EXPECT_NEAR(estimate.covariance(4, 4), 0.3, 1e-12);
}

TEST(ToGaussian, TakesOverWhatPoseAndFeaturesHaveInCommon) {
  // Of the features that the second lacks the rows go.
  auto first = component(0.5, {0, 0, 0}, {feature(1, 5, 0, 1), feature(2, 9, 0, 1)});
  first.covariance = Eigen::MatrixXd::Identity(7, 7);
  first.covariance(0, 5) = first.covariance(5, 0) = 0.4;
  auto second = component(0.5, {0, 0, 0}, {feature(2, 9, 0, 1)});
  second.covariance = 3 * Eigen::MatrixXd::Identity(5, 5);
  const auto estimate = gaussianOf({first, second});
  ASSERT_EQ(estimate.features.size(), 1u);
  EXPECT_NEAR(estimate.covariance(0, 0), 2, 1e-12);
  EXPECT_NEAR(estimate.covariance(0, 3), 0.2, 1e-12);
  EXPECT_NEAR(estimate.covariance(0, 4), 0, 1e-12);
}

TEST(ToGaussian, CorrectsTheSpreadOfFewSamples) {
  // Two equal weights: n = 2, (1 + 1/2) / (1 − 1/2) = 3.
  const auto plain = gaussianOf({component(0.5, {-1, 0, 0}, {}), component(0.5, {1, 0, 0}, {})});
  const auto corrected = gaussianOf({component(0.5, {-1, 0, 0}, {}), component(0.5, {1, 0, 0}, {})}, true);
  EXPECT_NEAR(plain.covariance(0, 0), 1, 1e-12);
  EXPECT_NEAR(corrected.covariance(0, 0), 3, 1e-12);
}

TEST(ToGaussian, AveragesHeadingsAcrossTheSeam) {
  const auto estimate =
      gaussianOf({component(0.5, {0, 0, M_PI - 0.1}, {}), component(0.5, {0, 0, -M_PI + 0.1}, {})});
  EXPECT_NEAR(std::abs(wrapped(estimate.pose[2])), M_PI, 1e-12);
  EXPECT_NEAR(estimate.covariance(2, 2), 0.01, 1e-12);
}

TEST(ToGaussian, DropsAParticleThatLacksAFeature) {
  const std::vector<MixtureComponent> components{
      component(0.5, {0, 0, 0}, {feature(1, 5, 0, 1), feature(2, 9, 0, 1)}),
      component(0.3, {2, 0, 0}, {feature(2, 9, 0, 1), feature(1, 5, 0, 1)}),
      component(0.2, {100, 0, 0}, {feature(1, 5, 0, 1)})};
  std::vector<std::size_t> kept;
  const auto estimate = toGaussian(components, {1, 0.3, false}, kept);
  EXPECT_THAT(kept, ::testing::ElementsAre(0u, 1u));
  EXPECT_NEAR(estimate.pose[0], 0.3 * 2 / 0.8, 1e-12) << "weights are normalised again";
  EXPECT_NEAR(estimate.features[1].x, 9, 1e-12) << "matched by id, not by position in the list";
}

TEST(ToGaussian, DropsAFeatureThatTooMuchOfTheWeightLacks) {
  const std::vector<MixtureComponent> components{
      component(0.4, {0, 0, 0}, {feature(1, 5, 0, 1), feature(2, 9, 0, 1)}),
      component(0.3, {1, 0, 0}, {feature(1, 5, 0, 1)}), component(0.3, {2, 0, 0}, {feature(1, 5, 0, 1)})};
  std::vector<std::size_t> kept;
  const auto estimate = toGaussian(components, {1, 0.3, false}, kept);
  EXPECT_EQ(kept.size(), 3u);
  ASSERT_EQ(estimate.features.size(), 1u);
  EXPECT_EQ(estimate.features[0].id, 1u);
}

TEST(ToGaussian, LeavesOutFeaturesSeenTooSeldomUnlessTheirIdIsKnown) {
  Feature known = feature(7, 1, 1, 1, 1);
  known.known = true;
  const auto estimate =
      gaussianOf({component(1, {0, 0, 0}, {feature(1, 5, 0, 1, 2), feature(2, 6, 0, 1, 3), known})}, true, 3);
  ASSERT_EQ(estimate.features.size(), 2u);
  EXPECT_EQ(estimate.features[0].id, 2u);
  EXPECT_EQ(estimate.features[1].id, 7u);
  EXPECT_TRUE(estimate.covariance.allFinite()) << "of a single particle";
}

}  // namespace
}  // namespace submap_slam::landmark_mapping
