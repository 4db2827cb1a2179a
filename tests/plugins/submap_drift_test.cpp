#include "odometry_pose_graph/submap_drift.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace submap_slam::pose_graph {
namespace {

using Eigen::Matrix3d;
using mrpt::math::TPose2D;

constexpr double kLength = 8;                // m
constexpr double kXy = 4e-6, kPhi = 2.5e-7;  // m², rad² over each metre

/** Of the end of a straight path along x, after a random walk: headings move the end by what is left of the
 * path. */
Matrix3d endOfRandomWalk() {
  Matrix3d covariance = Matrix3d::Zero();
  covariance(0, 0) = kXy * kLength;
  covariance(1, 1) = kXy * kLength + kPhi * kLength * kLength * kLength / 3;
  covariance(1, 2) = covariance(2, 1) = kPhi * kLength * kLength / 2;
  covariance(2, 2) = kPhi * kLength;
  return covariance;
}

TEST(SubmapDrift, FindsTheRateOfARandomWalk) {
  const SubmapDrift drift(endOfRandomWalk(), kLength);
  EXPECT_NEAR(drift.rate().phi, kPhi, 1e-12);
  const Matrix3d over = drift.over(2, {});
  EXPECT_NEAR(over(0, 0), 2 * kXy, 0.01 * kXy);
  // A heading that is known at the end says where the end is, up to a bend in between: L³/12 of L³/3.
  EXPECT_NEAR(over(1, 1), 2 * (kXy + kPhi * kLength * kLength / 12), 0.01 * kXy);
  EXPECT_NEAR(over(2, 2), 2 * kPhi, 1e-12);
}

TEST(SubmapDrift, IsSeenInTheAxesOfThePose) {
  const SubmapDrift drift(endOfRandomWalk(), kLength);
  const Matrix3d straight = drift.over(1, {}), across = drift.over(1, {3, 4, M_PI / 2});
  EXPECT_NEAR(across(0, 0), straight(1, 1), 1e-15);
  EXPECT_NEAR(across(1, 1), straight(0, 0), 1e-15);
}

/** Of the end of a straight path along x, put together from sections with their lever arms. */
Matrix3d endOfSections(const SubmapDrift& drift, int sections) {
  Matrix3d end = Matrix3d::Zero();
  const double length = kLength / sections;
  for (int k = 0; k < sections; ++k) {
    const TPose2D anchor(length * k, 0, 0);
    Matrix3d lever = Matrix3d::Identity();
    lever(1, 2) = k + 1 < sections ? kLength - length * (k + 1) : 0;
    const Matrix3d section = k + 1 < sections ? drift.over(length, anchor) : drift.overLast(length, anchor);
    end += lever * section * lever.transpose();
  }
  return end;
}

TEST(SubmapDrift, SectionsMakeUpTheEndPose) {
  const Matrix3d usual = endOfRandomWalk();
  const DriftRate rate = SubmapDrift(usual, kLength).rate();
  for (const double factor : {1.0, 4.0, 100.0}) {
    SubmapDrift drift(factor * usual, kLength);
    drift.limit(rate);
    EXPECT_LE(drift.rate().xy, 1.001 * rate.xy);
    const Matrix3d end = endOfSections(drift, 64), wanted = factor * usual;
    // Across the way the bend in between comes on top, once: a quarter of the usual.
    EXPECT_NEAR(end(0, 0), wanted(0, 0), 0.01 * wanted(0, 0));
    EXPECT_NEAR(end(1, 1), wanted(1, 1), 0.3 * usual(1, 1));
    EXPECT_NEAR(end(1, 2), wanted(1, 2), 0.03 * wanted(1, 2));
    EXPECT_NEAR(end(2, 2), wanted(2, 2), 0.01 * wanted(2, 2));
  }
}

TEST(SubmapDrift, KeepsToTheUsual) {
  SubmapDrift drift(endOfRandomWalk(), kLength);
  const Matrix3d before = drift.over(1, {});
  drift.limit({1, 1});
  EXPECT_EQ(drift.over(1, {}), before);
  EXPECT_EQ(drift.overLast(1, {}), before);
}

/** An end pose that is known exactly, and one known in one direction only. */
TEST(SubmapDrift, CovariancesHaveInverses) {
  Matrix3d singular = Matrix3d::Zero();
  singular(0, 0) = 1e-4;
  for (const Matrix3d& end : {Matrix3d(Matrix3d::Zero()), singular}) {
    const Matrix3d over = SubmapDrift(end, 5).over(0.01, {0, 0, 1});
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix3d>(over).eigenvalues().minCoeff(), 0);
  }
}

TEST(SubmapDrift, MedianRates) {
  const DriftRate median = medianOf({{1, 6}, {2, 4}, {9, 5}});
  EXPECT_EQ(median.xy, 2);
  EXPECT_EQ(median.phi, 5);
  EXPECT_EQ(medianOf({}).xy, 0);
}

}  // namespace
}  // namespace submap_slam::pose_graph
