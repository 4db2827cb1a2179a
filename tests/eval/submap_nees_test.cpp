#include <gtest/gtest.h>
#include <submap_slam/eval/submap_nees.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <memory>
#include <random>

namespace submap_slam {
namespace {

constexpr double kPi = 3.141592653589793;

/** From (1, 1) with heading 90° at 1 s to 2 m ahead and 2 m to the left at 2 s, heading 180°. */
TimedTrajectory path() {
  return TimedTrajectory(std::vector<TimedPose>{{1, toPose3D({1, 1, kPi / 2})}, {2, toPose3D({-1, 3, kPi})}});
}

/** The submap of that path with a feature at (3, 0) of its frame, of which (1, 4) is the truth. */
LandmarkSubmap::Ptr exactSubmap() {
  auto submap = std::make_shared<LandmarkSubmap>();
  submap->timestamp = mrpt::Clock::fromDouble(1);
  submap->end_stamp = mrpt::Clock::fromDouble(2);
  submap->end_pose = {2, 2, kPi / 2};
  submap->features = {{7, 3, 0, 5}};
  submap->covariance.setIdentity(5);
  return submap;
}

TEST(SubmapNees, HandWorkedCase) {
  auto submap = exactSubmap();
  EXPECT_NEAR(*neesPerDimension(*submap, {{7, {1, 4}}}, path()), 0, 1e-12);
  submap->end_pose.x += 1;
  submap->end_pose.phi += 2 * kPi + 0.5;  // wrapped: 0.5
  submap->features[0].y += 2;
  submap->covariance(2, 2) = 0.25;
  submap->covariance(4, 4) = 2;
  EXPECT_NEAR(*neesPerDimension(*submap, {{7, {1, 4}}}, path()), (1 + 1 + 2) / 5.0, 1e-9);
  // a feature without truth is left out
  EXPECT_NEAR(*neesPerDimension(*submap, {}, path()), (1 + 1) / 3.0, 1e-9);
  EXPECT_NEAR(*neesPerDimension(*submap, {{8, {1, 4}}}, path()), (1 + 1) / 3.0, 1e-9);
  submap->ids_known = false;
  EXPECT_NEAR(*neesPerDimension(*submap, {{7, {1, 4}}}, path()), (1 + 1) / 3.0, 1e-9);
}

TEST(SubmapNees, IsNothingWithoutTruthOrCovariance) {
  auto submap = exactSubmap();
  submap->covariance(1, 1) = 0;
  EXPECT_FALSE(neesPerDimension(*submap, {}, path()));
  submap = exactSubmap();
  submap->end_stamp = mrpt::Clock::fromDouble(100);
  EXPECT_FALSE(neesPerDimension(*submap, {}, path()));
  submap->end_stamp = INVALID_TIMESTAMP;
  EXPECT_FALSE(neesPerDimension(*submap, {}, path()));
  EXPECT_EQ(meanNeesPerDimension({submap}, {}, path()).used, 0u);
  EXPECT_EQ(meanNeesPerDimension({}, {}, path()).mean, 0);
}

/** Errors drawn from a full covariance: correlations count, so that one is expected. */
TEST(SubmapNees, IsOneForHonestCovariances) {
  Eigen::MatrixXd half = Eigen::MatrixXd::Identity(5, 5) * 0.1;
  half(3, 2) = 0.3;
  half(4, 0) = -0.2;
  const Eigen::MatrixXd covariance = half * half.transpose();
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  LandmarkSubmaps submaps;
  for (int k = 0; k < 2000; ++k) {
    auto submap = exactSubmap();
    const Eigen::VectorXd e = half * Eigen::VectorXd::NullaryExpr(5, [&] { return normal(generator); });
    submap->end_pose = {2 + e[0], 2 + e[1], kPi / 2 + e[2]};
    submap->features[0].x += e[3];
    submap->features[0].y += e[4];
    submap->covariance = covariance;
    submaps.push_back(submap);
  }
  const auto nees = meanNeesPerDimension(submaps, {{7, {1, 4}}}, path());
  EXPECT_EQ(nees.used, 2000u);
  EXPECT_NEAR(nees.mean, 1, 4 * std::sqrt(2.0 / (5 * 2000)));
}

}  // namespace
}  // namespace submap_slam
