#include <gmock/gmock.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/plugins.h>
#include <tbb/global_control.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "grid_gauss_newton/chain_prior.h"
#include "synthetic_submaps.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using testing::asGaussians;
using testing::renderSubmap;
using PoseList = std::vector<TPose2D>;

constexpr double kDegree = M_PI / 180;

/** The joiner as the program gets it: from the plugin file. */
class GridGaussNewtonPlugin : public ::testing::Test {
 protected:
  void SetUp() override {
    loadPlugin(GRID_GAUSS_NEWTON_PLUGIN);
    for (const auto& candidate : availableJoiners())
      if (candidate->name() == "grid_gauss_newton") joiner = candidate;
    ASSERT_TRUE(joiner);
    joiner->describe(parameters);
    // The synthetic submaps have coarse cells and honest covariances.
    parameters.set("grid_gauss_newton", "finest_level", "0");
    parameters.set("grid_gauss_newton", "prior_weight", "1");
  }

  JoinedMap join(const GridSubmaps& submaps, const PoseList& start) const {
    JoinedMap initial;
    initial.frames = asGaussians(start);
    joiner->validate();
    return joiner->join(submaps, initial, {});
  }

  std::shared_ptr<SubmapJoiner> joiner;
  ParameterTable parameters;
};

double distance(const TPose2D& a, const TPose2D& b) { return std::hypot(a.x - b.x, a.y - b.y); }

TPose2D frameOf(const JoinedMap& joined, std::size_t i) { return joined.frames[i].mean.asTPose(); }

void expectSameFrames(const JoinedMap& joined, const PoseList& frames) {
  ASSERT_EQ(joined.frames.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(frameOf(joined, i), frames[i]);
}

struct RoomProblem {
  PoseList truth{{0, 0, 0}, {1.5, 0.6, 0.7}, {-1.2, 0.9, -0.4}};
  GridSubmaps submaps;
  RoomProblem() {
    for (std::size_t i = 0; i < truth.size(); ++i)
      submaps.push_back(renderSubmap(testing::room(), truth[i], 5, 0.1, 0.1, static_cast<uint32_t>(i)));
  }
};

TEST_F(GridGaussNewtonPlugin, FindsAKnownDisplacementInARoom) {
  const PoseList truth{{0, 0, 0}, {1.5, 0.6, 0.7}};
  const GridSubmaps submaps{renderSubmap(testing::room(), truth[0], 5, 0.05),
                            renderSubmap(testing::room(), truth[1], 5, 0.05)};
  const TPose2D start(truth[1].x + 0.24, truth[1].y - 0.18, truth[1].phi + 3 * kDegree);
  const JoinedMap joined = join(submaps, {truth[0], start});
  EXPECT_EQ(joined.status, JoinStatus::kConverged) << joined.reason;
  EXPECT_EQ(frameOf(joined, 0), truth[0]);
  EXPECT_LT(distance(frameOf(joined, 1), truth[1]), 0.01);
  EXPECT_LT(std::abs(frameOf(joined, 1).phi - truth[1].phi), 0.1 * kDegree);
  EXPECT_FALSE(joined.iterations.empty());
}

TEST_F(GridGaussNewtonPlugin, FindsALargeDisplacementThroughThePyramid) {
  const RoomProblem p;
  PoseList start = p.truth;
  start[1] = {p.truth[1].x - 0.7, p.truth[1].y + 0.6, p.truth[1].phi - 5 * kDegree};
  start[2] = {p.truth[2].x + 0.6, p.truth[2].y + 0.4, p.truth[2].phi + 5 * kDegree};
  const JoinedMap joined = join(p.submaps, start);
  EXPECT_EQ(joined.status, JoinStatus::kConverged) << joined.reason;
  for (std::size_t i = 1; i < start.size(); ++i) EXPECT_LT(distance(frameOf(joined, i), p.truth[i]), 0.01);

  parameters.set("grid_gauss_newton", "levels", "1");
  const JoinedMap without = join(p.submaps, start);
  EXPECT_GT(distance(frameOf(without, 1), p.truth[1]), 0.1) << "this start is meant to need the pyramid";
}

TEST_F(GridGaussNewtonPlugin, EverySolverAndTheirFormsAgree) {
  const RoomProblem p;
  PoseList start = p.truth;
  start[1].x += 0.03, start[2].phi -= 0.01;
  parameters.set("grid_gauss_newton", "levels", "1");
  parameters.set("grid_gauss_newton", "finest_level", "1");
  for (const char* jacobian : {"paper", "variable_projection", "surface"}) {
    parameters.set("grid_gauss_newton", "jacobian", jacobian);
    parameters.set("grid_gauss_newton", "solver", "pose_only");
    const JoinedMap pose_only = join(p.submaps, start);
    EXPECT_EQ(pose_only.status, JoinStatus::kConverged) << jacobian << ": " << pose_only.reason;
    for (const char* solver : {"explicit_pose_only", "full"}) {
      parameters.set("grid_gauss_newton", "solver", solver);
      const JoinedMap other = join(p.submaps, start);
      for (std::size_t i = 0; i < start.size(); ++i)  // pose_only sums up tiles in single precision
        EXPECT_LT(distance(frameOf(other, i), frameOf(pose_only, i)), 2e-5) << jacobian << " " << solver;
    }
  }
}

struct CorridorProblem {
  PoseList truth;
  GridSubmaps submaps;
  explicit CorridorProblem(double noise) {
    for (std::size_t i = 0; i < 5; ++i) {
      truth.emplace_back(4.0 * static_cast<double>(i) - 8, 0.1, 0.05 * static_cast<double>(i));
      submaps.push_back(
          renderSubmap(testing::corridor(60), truth[i], 5, 0.1, noise, static_cast<uint32_t>(i)));
    }
    testing::linkChain(submaps, truth, 0.02, 0.003);
  }
};

TEST_F(GridGaussNewtonPlugin, StaysWhereTheChainHoldsItInACorridor) {
  const CorridorProblem p(0.15);
  const JoinedMap joined = join(p.submaps, p.truth);
  EXPECT_NE(joined.status, JoinStatus::kFailed) << joined.reason;
  for (std::size_t i = 0; i < p.truth.size(); ++i) {
    EXPECT_LT(std::abs(frameOf(joined, i).x - p.truth[i].x), 0.02);
    EXPECT_LT(std::abs(frameOf(joined, i).y - p.truth[i].y), 0.025);
  }
}

TEST_F(GridGaussNewtonPlugin, ComesBackToTheChainInACorridor) {
  const CorridorProblem p(0);
  PoseList start = p.truth;
  for (std::size_t i = 1; i < start.size(); ++i)
    start[i].x += i % 2 ? 0.5 : -0.4, start[i].phi += 2 * kDegree;
  const JoinedMap joined = join(p.submaps, start);
  EXPECT_NE(joined.status, JoinStatus::kFailed) << joined.reason;
  for (std::size_t i = 1; i < p.truth.size(); ++i) {
    const double two_sigma_of_the_chain = 2 * 0.02 * std::sqrt(static_cast<double>(i));
    EXPECT_LT(distance(frameOf(joined, i), p.truth[i]), two_sigma_of_the_chain) << i;
  }
}

TEST_F(GridGaussNewtonPlugin, CovarianceAlongACorridorIsNearlyThatOfTheChain) {
  const CorridorProblem p(0);
  const JoinedMap joined = join(p.submaps, p.truth);
  ASSERT_NE(joined.status, JoinStatus::kFailed) << joined.reason;
  EXPECT_LT(joined.frames[1].cov(0, 0), 0.02 * 0.02);
  EXPECT_GT(joined.frames[1].cov(0, 0), 0.5 * 0.02 * 0.02);
  EXPECT_LT(joined.frames[1].cov(1, 1), 0.1 * 0.02 * 0.02);
}

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

TEST_F(GridGaussNewtonPlugin, OneSubmapIsNothingToJoin) {
  const JoinedMap joined = join({renderSubmap(testing::room(), {0, 0, 0}, 2, 0.1)}, {{0, 0, 0}});
  EXPECT_EQ(joined.status, JoinStatus::kNothingToJoin);
  expectSameFrames(joined, {{0, 0, 0}});
}

TEST_F(GridGaussNewtonPlugin, SubmapsWithoutOverlapKeepTheirFrames) {
  const PoseList frames{{0, 0, 0}, {30, 0, 0.3}};
  const GridSubmaps submaps{renderSubmap(testing::room(), {0, 0, 0}, 3, 0.1),
                            renderSubmap(testing::room(), {0, 0, 0}, 3, 0.1)};
  const JoinedMap joined = join(submaps, frames);
  EXPECT_EQ(joined.status, JoinStatus::kNothingToJoin);
  EXPECT_THAT(joined.reason, ::testing::HasSubstr("overlap"));
  expectSameFrames(joined, frames);
}

TEST_F(GridGaussNewtonPlugin, GroupsWithoutLinkAreJoinedEachForItself) {
  const PoseList truth{{0, 0, 0}, {0.8, 0.3, 0.2}};
  GridSubmaps submaps;
  for (int group = 0; group < 2; ++group)
    for (const TPose2D& frame : truth) submaps.push_back(renderSubmap(testing::room(), frame, 4, 0.1));
  const TPose2D away(50, -20, 1.1), error(0.05, -0.03, 0.01);
  const JoinedMap joined =
      join(submaps, {truth[0], truth[1] + error, away + truth[0], away + truth[1] + error});
  EXPECT_EQ(joined.status, JoinStatus::kConverged) << joined.reason;
  EXPECT_LT(distance(frameOf(joined, 1), truth[1]), 0.01);
  EXPECT_EQ(frameOf(joined, 2), away + truth[0]);
  EXPECT_LT(distance(frameOf(joined, 3), away + truth[1]), 0.01);
}

TEST_F(GridGaussNewtonPlugin, DifferentResolutionsAreRefused) {
  const GridSubmaps submaps{renderSubmap(testing::room(), {0, 0, 0}, 3, 0.1),
                            renderSubmap(testing::room(), {0, 0, 0}, 3, 0.05)};
  EXPECT_THROW(join(submaps, {{0, 0, 0}, {0, 0, 0}}), InputError);
}

TEST_F(GridGaussNewtonPlugin, SameBitsForAnyNumberOfThreads) {
  const RoomProblem p;
  PoseList start = p.truth;
  start[1].x += 0.2, start[2].phi += 0.05;
  const auto with = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return join(p.submaps, start);
  };
  const JoinedMap one = with(1), two = with(2);
  EXPECT_EQ(one.objective, two.objective);
  ASSERT_EQ(one.iterations.size(), two.iterations.size());
  for (std::size_t i = 0; i < start.size(); ++i) {
    EXPECT_EQ(frameOf(one, i), frameOf(two, i));
    EXPECT_EQ(one.frames[i].cov.asEigen(), two.frames[i].cov.asEigen());
  }
}

TEST_F(GridGaussNewtonPlugin, KeepsConstraintsAndStopsOnRequest) {
  const RoomProblem p;
  JoinedMap initial;
  PoseList start = p.truth;
  start[1].x += 0.3;
  initial.frames = asGaussians(start);
  initial.constraints.resize(2);
  initial.constraints[1].to = 7;
  int calls = 0;
  const JoinedMap joined = joiner->join(p.submaps, initial, [&calls](double fraction, const std::string&) {
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    return ++calls < 3;
  });
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(joined.status, JoinStatus::kIterationLimit);
  EXPECT_EQ(joined.iterations.size(), 3u);
  ASSERT_EQ(joined.constraints.size(), 2u);
  EXPECT_EQ(joined.constraints[1].to, 7u);
}

TEST(ChainPrior, GradientAndMatrixAreDerivativesOfItsCost) {
  GridSubmaps submaps{GridSubmap::Create(), GridSubmap::Create(), GridSubmap::Create()};
  submaps[0]->has_successor = submaps[1]->has_successor = true;
  submaps[0]->end_pose.mean = mrpt::poses::CPose2D(1.0, 0.2, 3.0);
  submaps[1]->end_pose.mean = mrpt::poses::CPose2D(0.4, -0.6, -0.5);
  Eigen::Matrix3d cov;
  cov << 0.04, 0.01, 0.002, 0.01, 0.09, -0.003, 0.002, -0.003, 0.01;
  submaps[0]->end_pose.cov = cov;
  submaps[1]->end_pose.cov = cov;
  const grid_joining::ChainPrior prior(submaps, 2.5);
  const grid_joining::Frames frames{{0, 0, 0.4}, {0.7, 0.9, -2.8}, {0.9, 1.8, 2.9}};
  const auto system = prior.linearise(frames);
  const double h = 1e-6;
  for (Eigen::Index k = 0; k < 9; ++k) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(9);
    step[k] = h;
    const double difference =
        (prior.cost(grid_joining::moved(frames, step)) - prior.cost(grid_joining::moved(frames, -step))) /
        (2 * h);
    EXPECT_NEAR(2 * system.denseGradient()[k], difference, 1e-6 * (1 + std::abs(difference)));
  }
  EXPECT_EQ(grid_joining::ChainPrior(submaps, 0).cost(frames), 0);

  // At the prior's own optimum J^T Omega J is half the Hessian: check it along a direction.
  const grid_joining::Frames exact{
      frames[0], frames[0] + submaps[0]->end_pose.mean.asTPose(),
      frames[0] + submaps[0]->end_pose.mean.asTPose() + submaps[1]->end_pose.mean.asTPose()};
  EXPECT_NEAR(prior.cost(exact), 0, 1e-12);
  const Eigen::VectorXd along = Eigen::VectorXd::LinSpaced(9, -1, 1.3);
  EXPECT_NEAR(prior.cost(grid_joining::moved(exact, 1e-4 * along)) / 1e-8,
              along.dot(prior.linearise(exact).denseMatrix() * along), 1e-2 * along.squaredNorm());
}

}  // namespace
}  // namespace submap_slam
