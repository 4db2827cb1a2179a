#include <Eigen/Eigenvalues>

#include "grid_gauss_newton/jacobian.h"
#include "grid_gauss_newton/observability.h"
#include "grid_joining_fixture.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

TEST_F(GridGaussNewtonPlugin, CovariancesArePositiveAndGrowWithLessEvidence) {
  const RoomProblem p;
  const JoinedMap joined = join(p.submaps, p.truth);
  ASSERT_EQ(joined.status, JoinStatus::kConverged) << joined.reason;
  EXPECT_EQ(joined.frames[0].cov.asEigen().norm(), 0);
  for (std::size_t i = 1; i < p.truth.size(); ++i) {
    const Eigen::Matrix3d cov = joined.frames[i].cov.asEigen();
    EXPECT_EQ((cov - cov.transpose()).norm(), 0);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(cov).eigenvalues().minCoeff(), 0);
    EXPECT_LT(cov(0, 0), 0.05 * 0.05);
  }
  parameters.set("grid_gauss_newton", "correlation_length", "2");
  const JoinedMap doubtful = join(p.submaps, p.truth);
  EXPECT_NEAR(doubtful.frames[1].cov(0, 0), 4 * joined.frames[1].cov(0, 0), 0.1 * joined.frames[1].cov(0, 0));
}

TEST_F(GridGaussNewtonPlugin, CovarianceAlongACorridorIsNearlyThatOfTheChain) {
  const CorridorProblem p(0);
  const JoinedMap joined = join(p.submaps, p.truth);
  ASSERT_NE(joined.status, JoinStatus::kFailed) << joined.reason;
  EXPECT_LT(joined.frames[1].cov(0, 0), 0.02 * 0.02);
  EXPECT_GT(joined.frames[1].cov(0, 0), 0.5 * 0.02 * 0.02);
  EXPECT_LT(joined.frames[1].cov(1, 1), 0.1 * 0.02 * 0.02);
}

TEST_F(GridGaussNewtonPlugin, LeavesNothingOpenInARoom) {
  const RoomProblem p;
  testing::linkChain(p.submaps, p.truth, 0.5, 0.1);
  const JoinedMap joined = join(p.submaps, p.truth);
  EXPECT_THAT(joined.reason, ::testing::Not(::testing::HasSubstr("open")));
}

/** Two frames: the evidence holds the second one along y and its heading, the chain all of it. */
TEST(OpenDirections, AreThoseThatTheEvidenceAloneDoesNotHold) {
  using namespace grid_joining;
  Evaluation evaluation{ReducedSystem(2), PoseSystem(2), PoseSystem(2)};
  const double turn = 0.3;
  const auto link = [&](PoseSystem& system, const Eigen::Vector3d& sigmas) {
    const Eigen::Matrix3d axes = globalToLocalMotion(turn);
    const Eigen::Vector3d information = sigmas.cwiseAbs2().cwiseInverse();
    const Eigen::Matrix3d block = axes.transpose() * information.asDiagonal() * axes;
    system.addBlock(0, 0, block);
    system.addBlock(0, 1, -block);
    system.addBlock(1, 1, block);
  };
  link(evaluation.evidence.system, {10, 0.01, 0.001});
  link(evaluation.prior, {0.2, 0.2, 0.1});
  evaluation.total.add(evaluation.prior, 1);
  evaluation.total.add(evaluation.evidence.system, 1);
  const auto covariances = marginalCovariances(evaluation.total, {true, false}, Eigen::VectorXd::Zero(6));
  ASSERT_TRUE(covariances);
  const auto open = openDirections(evaluation, 1, *covariances, 0.05);
  ASSERT_EQ(open.size(), 1u);
  EXPECT_EQ(open[0].submap, 1u);
  EXPECT_FALSE(open[0].heading);
  EXPECT_NEAR(open[0].direction, turn, 1e-3);
  EXPECT_NEAR(open[0].sigma, 0.2, 1e-3);
  EXPECT_EQ(describeOpen(open, {4, 7}), "evidence leaves open submap 7 along 17 deg (sigma 0.2 m)");
  EXPECT_EQ(describeOpen({}, {4, 7}), "");
  EXPECT_EQ(describeGroups({0, 0}, {4, 7}), "");
  EXPECT_EQ(describeGroups({0, 0, 2, 0, 2}, {4, 5, 6, 7, 8}),
            "2 groups that nothing links, each joined for itself: {4-5, 7} {6, 8}");
}

}  // namespace
}  // namespace submap_slam
