/** Where the evidence is silent in one direction. */
#include "grid_joining_fixture.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using testing::asGaussians;

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

}  // namespace
}  // namespace submap_slam
