#include <submap_slam/mapping/drift_covariance.h>

#include <gtest/gtest.h>
#include <Eigen/Core>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

DriftParams withoutFloor() { return {1.0, 1.0, 0.0, 0.0}; }

const Eigen::Matrix3d kNothing = Eigen::Matrix3d::Zero();

TEST(DriftCovariance, AHeadingErrorMovesTheEndByItsLeverArm) {
  DriftCovariance drift(withoutFloor());
  drift.addKeyScan(Eigen::Vector3d(1e12, 1e12, 1 / (0.01 * 0.01)).asDiagonal(), kNothing);
  drift.move({0, 0, 0}, {3, 4, 0.5});
  // 0.01 rad over a lever arm (3, 4) m: the end moves by 0.01 · (−4, 3).
  const Eigen::Matrix3d P = drift.covariance();
  EXPECT_NEAR(P(0, 0), 0.04 * 0.04, 1e-9);
  EXPECT_NEAR(P(1, 1), 0.03 * 0.03, 1e-9);
  EXPECT_NEAR(P(0, 1), -0.04 * 0.03, 1e-9);
  EXPECT_NEAR(drift.sigmaXy(), 0.05, 1e-6);
  EXPECT_NEAR(drift.sigmaPhi(), 0.01, 1e-9);
}

TEST(DriftCovariance, KeyScansAddAndTheFloorGrowsWithThePath) {
  DriftCovariance drift({0.5, 1.0, 0.01, 0.001});
  for (int i = 0; i < 3; ++i) drift.addKeyScan(Eigen::Matrix3d::Identity() * 100, kNothing);
  drift.move({0, 0, 0}, {0, 0, 0});
  EXPECT_NEAR(drift.covariance()(2, 2), 3 * 0.25 / 100 + 1e-6 * 0.1, 1e-12);
  DriftCovariance far({0.5, 1.0, 0.01, 0.001});
  far.move({0, 0, 0}, {4, 0, 0});
  EXPECT_NEAR(far.sigmaXy(), 0.01 * 2, 1e-12);
}

TEST(DriftCovariance, OdometryHoldsWhatTheScanLeavesFree) {
  DriftCovariance drift({0.5, 2.0, 0, 0});
  drift.addKeyScan(Eigen::Vector3d(0, 100, 100).asDiagonal(), Eigen::Matrix3d::Identity() * 25);
  EXPECT_NEAR(drift.covariance()(0, 0), 4.0 / 25, 1e-12);
  EXPECT_NEAR(drift.covariance()(1, 1), 1 / (100 / 0.25 + 25 / 4.0), 1e-12);
}

}  // namespace
}  // namespace submap_slam
