/** Least squares over a submap, worked by hand. */
#include <gtest/gtest.h>

#include <submap_slam/landmarks/path_smoother.h>

namespace submap_slam::landmark_mapping {
namespace {

constexpr double kExact = 1e-10, kVariance = 0.01;

MotionStep ahead(double metres, double variance) {
  return {{metres, 0, 0}, Eigen::Vector3d(variance, kExact, kExact).asDiagonal()};
}

Sighting straightAhead(std::size_t step, double range, std::size_t feature = 0) {
  Sighting sighting;
  sighting.step = step;
  sighting.T_robot_sensor = Pose::Zero();
  sighting.value = {{range, 0}, Eigen::Vector2d(kVariance, kExact).asDiagonal()};
  sighting.feature = feature;
  return sighting;
}

TEST(PathSmoother, SharesAContradictionAmongAllThatTakePartInIt) {
  // A step of 1 m, a feature 5 m ahead before it and 4.1 m after it: 0.1 m too much, a third for each of the
  // three. The information of (x, feature) is [2 −1; −1 2] / 0.01.
  const auto submap = smoothSubmap({ahead(1, kVariance)}, {straightAhead(0, 5), straightAhead(1, 4.1)},
                                   {Pose::Zero(), Pose(3, 0.2, 0.1)});
  ASSERT_TRUE(submap);
  EXPECT_LT(submap->path[0].norm(), 1e-6);
  EXPECT_LT((submap->path[1] - Pose(1 - 0.1 / 3, 0, 0)).norm(), 1e-4);
  ASSERT_EQ(submap->features.size(), 1u);
  EXPECT_LT((submap->features[0] - Point(5 + 0.1 / 3, 0)).norm(), 1e-4);
  EXPECT_NEAR(submap->covariance(0, 0), 2 * kVariance / 3, 1e-5);
  EXPECT_NEAR(submap->covariance(3, 3), 2 * kVariance / 3, 1e-5);
  EXPECT_NEAR(submap->covariance(0, 3), kVariance / 3, 1e-5);
}

TEST(PathSmoother, WhereTheRobotStandsMeasurementsAreAveraged) {
  const auto submap = smoothSubmap(
      {ahead(0, 0), ahead(0, 0)},
      {straightAhead(0, 4.8), straightAhead(1, 5.1), straightAhead(2, 8, 1), straightAhead(2, 5.4)},
      std::vector<Pose>(3, Pose::Zero()));
  ASSERT_TRUE(submap);
  EXPECT_LT(submap->path[2].norm(), 1e-3);
  EXPECT_NEAR(submap->features[0].x(), 5.1, 1e-3);
  EXPECT_NEAR(submap->features[1].x(), 8, 1e-3);
  EXPECT_NEAR(submap->covariance(3, 3), kVariance / 3, 1e-5);
}

/** A measurement that takes information away, as rounding may do where variances differ too much. */
Sighting takingAway(Sighting sighting, double information) {
  sighting.value.noise(0, 0) = -1 / information;
  return sighting;
}

TEST(PathSmoother, FailsWhereTheInformationInTheEndIsNotPositive) {
  EXPECT_FALSE(smoothSubmap({}, {takingAway(straightAhead(0, 5), 100)}, {Pose::Zero()}));
}

TEST(PathSmoother, FailsWhereThatOfAnEliminatedPoseIsNotPositive) {
  // Of (x_1, x_2, feature) it is [−800 −100 1000; −100 100 0; 1000 0 −900]: without x_1 it looks positive,
  // [112.5 −125; −125 350].
  EXPECT_FALSE(smoothSubmap({ahead(1, kVariance), ahead(1, kVariance)},
                            {straightAhead(0, 5), takingAway(straightAhead(1, 4), 1000)},
                            {Pose::Zero(), Pose(1, 0, 0), Pose(2, 0, 0)}));
}

TEST(PathSmoother, FailsWhereAPoseIsNotANumber) {
  EXPECT_FALSE(smoothSubmap({ahead(1, kVariance)}, {straightAhead(0, 5)}, {Pose::Zero(), Pose(NAN, 0, 0)}));
}

}  // namespace
}  // namespace submap_slam::landmark_mapping
