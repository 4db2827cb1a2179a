#include <submap_slam/core/edits.h>
#include <tbb/global_control.h>

#include <Eigen/Core>

#include "grid_joining_fixture.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using testing::asGaussians;
using testing::renderSubmap;

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
  const PackedEvidence map = fuseEvidence(masked, joined.frames, 0.1);
  const PackedEvidence without =
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

}  // namespace
}  // namespace submap_slam
