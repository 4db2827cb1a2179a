#include <submap_slam/mapping/drift_covariance.h>

#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>
#include <submap_slam/mapping/grid_mapper.h>
#include <submap_slam/mapping/stretch_splitter.h>
#include <submap_slam/simulation/path.h>
#include <submap_slam/simulation/simulate.h>
#include <submap_slam/simulation/world.h>
#include <Eigen/LU>

#include <cmath>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

DriftParams withoutFloor() { return {1.0, 0.0, 0.0}; }

TEST(DriftCovariance, AHeadingErrorMovesTheEndByItsLeverArm) {
  DriftCovariance drift(withoutFloor());
  drift.addKeyScan(Eigen::Vector3d(1e12, 1e12, 1 / (0.01 * 0.01)).asDiagonal());
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
  DriftCovariance drift({0.5, 0.01, 0.001});
  for (int i = 0; i < 3; ++i) drift.addKeyScan(Eigen::Matrix3d::Identity() * 100);
  drift.move({0, 0, 0}, {0, 0, 0});
  EXPECT_NEAR(drift.covariance()(2, 2), 3 * 0.25 / 100 + 1e-6 * 0.1, 1e-12);
  DriftCovariance far({0.5, 0.01, 0.001});
  far.move({0, 0, 0}, {4, 0, 0});
  EXPECT_NEAR(far.sigmaXy(), 0.01 * 2, 1e-12);
}

/** Mean over submaps of the normalised squared error of the end pose, divided by its three degrees of
 * freedom. */
double meanNeesPerDof(const std::string& world_name) {
  const World world = makeWorld(world_name);
  double sum = 0;
  int submaps = 0;
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    const SimulatedLog log = simulate(world, drive(world.route, {}, 5), {}, {}, seed);
    const RbpfGridMapper mapper({}, seed);
    StretchSplitter splitter(StretchParams{});
    for (const auto& frame : log.frames) {
      const auto stretch = splitter.push(frame);
      if (!stretch) continue;
      for (const auto& submap : mapper.map(*stretch)) {
        const TPose2D truth = log.truth[submap->end_frame].pose - log.truth[submap->first_frame].pose;
        const TPose2D end = submap->end_pose.mean.asTPose();
        const Eigen::Vector3d error(end.x - truth.x, end.y - truth.y,
                                    mrpt::math::wrapToPi(end.phi - truth.phi));
        sum += error.dot(submap->end_pose.cov.asEigen().inverse() * error) / 3;
        ++submaps;
      }
    }
  }
  return sum / submaps;
}

TEST(EndPoseCovariance, IsHonestInRooms) {
  const double nees = meanNeesPerDof("room");
  EXPECT_GT(nees, 0.5);
  EXPECT_LT(nees, 1.5);
}

TEST(EndPoseCovariance, IsHonestInACorridor) {
  const double nees = meanNeesPerDof("corridor");
  EXPECT_GT(nees, 0.5);
  EXPECT_LT(nees, 1.5);
}

TEST(EndPoseCovariance, IsHonestRoundALoop) {
  const double nees = meanNeesPerDof("loop");
  EXPECT_GT(nees, 0.5);
  EXPECT_LT(nees, 1.5);
}

}  // namespace
}  // namespace submap_slam
