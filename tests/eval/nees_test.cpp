#include <gtest/gtest.h>
#include <submap_slam/eval/nees.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::poses::CPosePDFGaussian;

CPosePDFGaussian gaussian(const TPose2D& mean, double xx, double xy, double yy, double pp) {
  mrpt::math::CMatrixDouble33 cov;
  cov.setZero();
  cov(0, 0) = xx, cov(1, 1) = yy, cov(2, 2) = pp;
  cov(0, 1) = cov(1, 0) = xy;
  return {mrpt::poses::CPose2D(mean), cov};
}

}  // namespace

TEST(Nees, SumOfSquaredSigmasForADiagonalCovariance) {
  const auto estimate = gaussian({1.2, 1.9, 0.1}, 0.04, 0, 0.0025, 0.01);
  // (0.2/0.2)² + (0.1/0.05)² + (0.1/0.1)²
  EXPECT_NEAR(nees(estimate, {1, 2, 0}).value(), 1 + 4 + 1, 1e-9);
}

TEST(Nees, CorrelationCounts) {
  // [[2,1],[1,2]]⁻¹ = [[2,-1],[-1,2]]/3: an error along the correlation is likelier than one across.
  const auto estimate = gaussian({0, 0, 0}, 2, 1, 2, 1);
  EXPECT_NEAR(nees(estimate, {1, 1, 0}).value(), 2.0 / 3, 1e-12);
  EXPECT_NEAR(nees(estimate, {1, -1, 0}).value(), 2.0, 1e-12);
}

TEST(Nees, HeadingErrorIsWrapped) {
  const auto estimate = gaussian({0, 0, M_PI - 0.05}, 1, 0, 1, 0.01);
  EXPECT_NEAR(nees(estimate, {0, 0, -M_PI + 0.05}).value(), 1, 1e-9);
}

TEST(Nees, NothingForACovarianceThatIsNotPositiveDefinite) {
  EXPECT_FALSE(nees(gaussian({0, 0, 0}, 0, 0, 0, 0), {0, 0, 0}));
  EXPECT_FALSE(nees(gaussian({0, 0, 0}, 1, 2, 1, 1), {0, 0, 0}));
  EXPECT_FALSE(nees(gaussian({0, 0, 0}, std::numeric_limits<double>::quiet_NaN(), 0, 1, 1), {0, 0, 0}));
}

TEST(MeanNees, SkipsTheFixedFirstFrame) {
  const auto result = meanNees(
      {gaussian({0, 0, 0}, 0, 0, 0, 0), gaussian({1, 0, 0}, 1, 0, 1, 1), gaussian({2, 0, 0}, 1, 0, 1, 1)},
      {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  EXPECT_EQ(result.used, 2u);
  EXPECT_EQ(result.skipped, 1u);
  EXPECT_DOUBLE_EQ(result.mean, (1 + 4) / 2.0);
}

TEST(MeanNees, IsThreeForHonestCovariances) {
  std::mt19937_64 engine(7);
  std::normal_distribution<double> normal;
  std::vector<CPosePDFGaussian> estimates;
  std::vector<TPose2D> truth;
  for (int i = 0; i < 4000; ++i) {
    // x and y with covariance L Lᵀ, L = [[0.3, 0], [0.2, 0.1]]; heading with sigma 0.05, around ±π.
    const double a = normal(engine), b = normal(engine), c = normal(engine);
    estimates.push_back(gaussian({0.3 * a, 0.2 * a + 0.1 * b, M_PI + 0.05 * c}, 0.09, 0.06, 0.05, 0.0025));
    truth.push_back({0, 0, M_PI});
  }
  EXPECT_NEAR(meanNees(estimates, truth).mean, 3, 0.15);  // four standard deviations of the mean
}

TEST(MeanNees, EmptyAndMismatchedInput) {
  EXPECT_EQ(meanNees({}, {}).used, 0u);
  EXPECT_THROW(meanNees({}, {{0, 0, 0}}), std::invalid_argument);
}

}  // namespace submap_slam
