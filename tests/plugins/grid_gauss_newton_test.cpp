#include <gmock/gmock.h>
#include <submap_slam/core/edits.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/plugins.h>
#include <submap_slam/core/submap_joiner.h>
#include <tbb/global_control.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "grid_gauss_newton/constraint_prior.h"
#include "grid_gauss_newton/jacobian.h"
#include "grid_gauss_newton/observability.h"
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
      if (candidate->name() == "grid_gauss_newton")
        joiner = std::dynamic_pointer_cast<SubmapJoiner>(candidate);
    ASSERT_TRUE(joiner);
    joiner->describe(parameters);
    // The synthetic submaps have coarse cells and honest covariances.
    parameters.set("grid_gauss_newton", "finest_level", "0");
    parameters.set("grid_gauss_newton", "prior_weight", "1");
  }

  JoinedMap join(const GridSubmaps& submaps, const PoseList& start) const {
    JoinedMap initial;
    initial.frames = asGaussians(start);
    initial.constraints = chainSubmaps(submaps).constraints;
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

TEST_F(GridGaussNewtonPlugin, AMaskedSubmapFollowsTheChainAndGivesNothingToTheMap) {
  RoomProblem room;
  testing::linkChain(room.submaps, room.truth, 0.01, 0.01);
  Edits edits;
  edits.list.emplace_back().to = 2;
  const GridSubmaps masked = maskSubmaps(room.submaps, edits);
  const JoinedMap joined = join(masked, room.truth);
  EXPECT_EQ(joined.status, JoinStatus::kConverged) << joined.reason;
  const TPose2D link = room.submaps[1]->end_pose.mean.asTPose();
  EXPECT_LT(distance(frameOf(joined, 2), frameOf(joined, 1) + link), 1e-3);
  const EvidenceGrid map = fuseEvidence(masked, joined.frames, 0.1);
  const EvidenceGrid without =
      fuseEvidence({masked[0], masked[1]}, {joined.frames[0], joined.frames[1]}, 0.1);
  EXPECT_EQ(map.observedCells(), without.observedCells());
}

TEST_F(GridGaussNewtonPlugin, AConstraintByHandMovesAFrame) {
  RoomProblem room;
  testing::linkChain(room.submaps, room.truth, 1, 1);
  JoinedMap initial;
  initial.frames = asGaussians(room.truth);
  initial.constraints = chainSubmaps(room.submaps).constraints;
  Constraint& fixed = initial.constraints.emplace_back();
  fixed.from = 0;
  fixed.to = 2;
  fixed.by_hand = fixed.inter = true;
  const TPose2D elsewhere(room.truth[2].x + 0.3, room.truth[2].y, room.truth[2].phi);
  fixed.T_a_b.mean = mrpt::poses::CPose2D(elsewhere);
  fixed.T_a_b.cov.setDiagonal(3, 1e-6);
  const JoinedMap joined = joiner->join(room.submaps, initial, {});
  EXPECT_LT(distance(frameOf(joined, 2), elsewhere), 0.05) << joined.reason;
  EXPECT_TRUE(joined.constraints.back().by_hand);
}

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

TEST_F(GridGaussNewtonPlugin, ShowsItsFramesAfterEachIterationAndGivesTheSameResult) {
  const RoomProblem p;
  PoseList start = p.truth;
  start[1].x += 0.2;
  JoinedMap initial;
  initial.frames = asGaussians(start);
  initial.constraints = chainSubmaps(p.submaps).constraints;
  std::vector<PoseList> shown;
  const ProgressCallback progress([](double, const std::string&) { return true; },
                                  [&shown](const PoseList& frames) { shown.push_back(frames); });
  const JoinedMap joined = joiner->join(p.submaps, initial, progress);
  EXPECT_EQ(shown.size(), joined.iterations.size());
  ASSERT_FALSE(shown.empty());
  expectSameFrames(joined, shown.back());
  expectSameFrames(join(p.submaps, start), shown.back());
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

/** Another joiner may know more than the constraints say; where the evidence is silent its frames stay. */
TEST_F(GridGaussNewtonPlugin, ConstraintsHoldFramesWhereTheJoinerBeforeHasPutThem) {
  const CorridorProblem p(0);
  JoinedMap initial;
  PoseList start = p.truth;
  for (std::size_t i = 1; i < start.size(); ++i) start[i].x += 0.3;
  initial.frames = asGaussians(start);
  initial.constraints = chainSubmaps(p.submaps).constraints;
  initial.status = JoinStatus::kConverged;
  const JoinedMap held = joiner->join(p.submaps, initial, {});
  EXPECT_NEAR(frameOf(held, 1).x, start[1].x, 0.05) << held.reason;
  EXPECT_EQ(held.constraints[0].T_a_b.mean, initial.constraints[0].T_a_b.mean) << "as they were given";

  initial.status = JoinStatus::kChained;
  const JoinedMap pulled = joiner->join(p.submaps, initial, {});
  EXPECT_NEAR(frameOf(pulled, 1).x, p.truth[1].x, 0.05) << pulled.reason;

  initial.status = JoinStatus::kConverged;
  for (auto& constraint : initial.constraints) constraint.by_hand = true;
  const JoinedMap by_hand = joiner->join(p.submaps, initial, {});
  EXPECT_NEAR(frameOf(by_hand, 1).x, p.truth[1].x, 0.05) << by_hand.reason;
}

TEST_F(GridGaussNewtonPlugin, CovarianceAlongACorridorIsNearlyThatOfTheChain) {
  const CorridorProblem p(0);
  const JoinedMap joined = join(p.submaps, p.truth);
  ASSERT_NE(joined.status, JoinStatus::kFailed) << joined.reason;
  EXPECT_LT(joined.frames[1].cov(0, 0), 0.02 * 0.02);
  EXPECT_GT(joined.frames[1].cov(0, 0), 0.5 * 0.02 * 0.02);
  EXPECT_LT(joined.frames[1].cov(1, 1), 0.1 * 0.02 * 0.02);
}

TEST_F(GridGaussNewtonPlugin, NamesTheDirectionThatACorridorLeavesOpen) {
  const CorridorProblem p(0);
  const JoinedMap joined = join(p.submaps, p.truth);
  EXPECT_THAT(joined.reason, ::testing::HasSubstr("evidence leaves open submap"));
  EXPECT_THAT(joined.reason, ::testing::HasSubstr("and 1 more"));
  EXPECT_THAT(joined.reason, ::testing::Not(::testing::HasSubstr("heading")));
  EXPECT_THAT(joined.reason, ::testing::Not(::testing::HasSubstr("groups")));

  parameters.set("grid_gauss_newton", "prior_weight", "0");
  const JoinedMap free = join(p.submaps, p.truth);
  EXPECT_THAT(free.reason, ::testing::ContainsRegex("submap 1 along [0-9] deg \\(sigma 0.1 m\\)"))
      << "without the chain";
}

TEST_F(GridGaussNewtonPlugin, LeavesNothingOpenInARoom) {
  const RoomProblem p;
  testing::linkChain(p.submaps, p.truth, 0.5, 0.1);
  const JoinedMap joined = join(p.submaps, p.truth);
  EXPECT_THAT(joined.reason, ::testing::Not(::testing::HasSubstr("open")));
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

/** A sheet of 32 × 32 submaps that was driven row by row, forth and back. */
TEST_F(GridGaussNewtonPlugin, JoinsAThousandSubmaps) {
  constexpr int kSide = 32;
  PoseList truth;
  for (int row = 0; row < kSide; ++row)
    for (int k = 0; k < kSide; ++k) {
      const double i = static_cast<double>(truth.size());
      truth.emplace_back(3.0 * (row % 2 ? kSide - 1 - k : k), 3.0 * row, truth.empty() ? 0 : 3 * std::sin(i));
    }
  GridSubmaps submaps;
  PoseList start = truth;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    submaps.push_back(testing::landscapeSubmap(truth[i], 2, 0.2));
    const double k = static_cast<double>(i);
    if (i > 0)
      start[i] = start[i] + TPose2D(0.15 * std::sin(7 * k), 0.15 * std::cos(5 * k), 0.03 * std::sin(3 * k));
  }
  testing::linkChain(submaps, truth, 0.02, 0.01);
  parameters.set("grid_gauss_newton", "levels", "2");  // the submaps are small
  const JoinedMap joined = join(submaps, start);
  EXPECT_EQ(joined.status, JoinStatus::kConverged) << joined.reason;
  double worst_step = 0;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const TPose2D step = frameOf(joined, i) - frameOf(joined, i - 1), true_step = truth[i] - truth[i - 1];
    worst_step = std::max(worst_step, distance(step, true_step));
    ASSERT_GT(joined.frames[i].cov(0, 0), 0) << i;
  }
  EXPECT_LT(worst_step, 0.03) << "from up to 0.3 m";
}

TEST_F(GridGaussNewtonPlugin, OneSubmapIsNothingToJoin) {
  const JoinedMap joined = join({renderSubmap(testing::room(), {0, 0, 0}, 2, 0.1)}, {{0, 0, 0}});
  EXPECT_EQ(joined.status, JoinStatus::kNothingToJoin);
  EXPECT_EQ(joined.reason, "there is only one submap");
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
    for (const TPose2D& frame : truth) {
      submaps.push_back(renderSubmap(testing::room(), frame, 4, 0.1));
      submaps.back()->id = static_cast<uint32_t>(submaps.size()) - 1;
    }
  const TPose2D away(50, -20, 1.1), error(0.05, -0.03, 0.01);
  const JoinedMap joined =
      join(submaps, {truth[0], truth[1] + error, away + truth[0], away + truth[1] + error});
  EXPECT_EQ(joined.status, JoinStatus::kConverged) << joined.reason;
  EXPECT_LT(distance(frameOf(joined, 1), truth[1]), 0.01);
  EXPECT_EQ(frameOf(joined, 2), away + truth[0]);
  EXPECT_LT(distance(frameOf(joined, 3), away + truth[1]), 0.01);
  EXPECT_THAT(joined.reason, ::testing::HasSubstr("2 groups that nothing links"));
  EXPECT_THAT(joined.reason, ::testing::HasSubstr("{0-1} {2-3}"));
}

TEST_F(GridGaussNewtonPlugin, JoinsSubmapsWithCellsOfHalfTheSize) {
  const PoseList truth{{0, 0, 0}, {0.8, 0.3, 0.3}, {-0.4, 0.5, -0.2}};
  const GridSubmaps submaps{renderSubmap(testing::room(), truth[0], 4, 0.1),
                            renderSubmap(testing::room(), truth[1], 4, 0.05),
                            renderSubmap(testing::room(), truth[2], 4, 0.025)};
  const JoinedMap joined = join(submaps, {truth[0], truth[1] + TPose2D(0.2, -0.1, 0.03), truth[2]});
  EXPECT_EQ(joined.status, JoinStatus::kConverged) << joined.reason;
  EXPECT_LT(distance(frameOf(joined, 1), truth[1]), 0.01);
  EXPECT_LT(distance(frameOf(joined, 2), truth[2]), 0.01);
  EXPECT_THAT(joined.reason,
              ::testing::HasSubstr("2 submaps with smaller cells were summed up to cells of 0.1 m"));
}

TEST_F(GridGaussNewtonPlugin, ResolutionsThatDoNotFitAreRefused) {
  const GridSubmaps submaps{renderSubmap(testing::room(), {0, 0, 0}, 3, 0.1),
                            renderSubmap(testing::room(), {0, 0, 0}, 3, 0.08)};
  try {
    join(submaps, {{0, 0, 0}, {0, 0, 0}});
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("has cells of 0.08 m; expected 0.1 m"));
  }
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

TEST(ConstraintPrior, GradientAndMatrixAreDerivativesOfItsCost) {
  GridSubmaps submaps{GridSubmap::Create(), GridSubmap::Create(), GridSubmap::Create()};
  submaps[1]->id = 1, submaps[2]->id = 2;
  submaps[0]->has_successor = submaps[1]->has_successor = true;
  submaps[0]->end_pose.mean = mrpt::poses::CPose2D(1.0, 0.2, 3.0);
  submaps[1]->end_pose.mean = mrpt::poses::CPose2D(0.4, -0.6, -0.5);
  Eigen::Matrix3d cov;
  cov << 0.04, 0.01, 0.002, 0.01, 0.09, -0.003, 0.002, -0.003, 0.01;
  submaps[0]->end_pose.cov = cov;
  submaps[1]->end_pose.cov = cov;
  const grid_joining::ConstraintPrior prior(chainSubmaps(submaps).constraints, submaps, 2.5);
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
  EXPECT_EQ(grid_joining::ConstraintPrior(chainSubmaps(submaps).constraints, submaps, 0).cost(frames), 0);

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
