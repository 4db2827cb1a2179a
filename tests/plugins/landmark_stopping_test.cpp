#include <gmock/gmock.h>

#include <Eigen/LU>

#include "eif_tree/known_association.h"
#include "landmark_joining_fixture.h"
#include "landmark_world.h"

namespace submap_slam {
namespace {

using namespace landmark_joining;
using testing::by;
using testing::EifTreePlugin;
using ::testing::HasSubstr;
using testing::simulateLandmarks;
using testing::stacked;

TEST(EifTree, StoppingGivesTheBestSoFar) {
  const auto associated = associateByIds(simulateLandmarks({}));
  const Joining joining = joinBy({}, associated.problem, [](double) { return false; });
  EXPECT_EQ(joining.result.status, JoinStatus::kIterationLimit);
  EXPECT_TRUE(stacked(joining.state).allFinite());
}

TEST(EifTree, AStoppedTreeSaysSo) {
  const auto associated = associateByIds(simulateLandmarks({}));
  const Joining stopped = joinBy(by(Method::kTree), associated.problem, [](double) { return false; });
  EXPECT_EQ(stopped.result.status, JoinStatus::kIterationLimit);
  EXPECT_THAT(stopped.result.reason, HasSubstr("stopped"));
  EXPECT_TRUE(stacked(stopped.state).allFinite());
  const Joining whole = joinBy(by(Method::kTree), associated.problem, {});
  EXPECT_EQ(whole.result.status, JoinStatus::kConverged);
  EXPECT_LT(whole.result.objective, stopped.result.objective);
  const Joining in_the_end =
      joinBy(by(Method::kTree), associated.problem, [](double share) { return share < 1; });
  EXPECT_EQ(in_the_end.result.status, JoinStatus::kConverged) << "nothing was left to do";
}

TEST(EifTree, AStoppedFilterKeepsWhatWasFusedAndChainsTheRest) {
  const auto submaps = simulateLandmarks({});
  constexpr std::size_t kFused = 5;
  const auto part = associateByIds(LandmarkSubmaps(submaps.begin(), submaps.begin() + kFused));
  const auto associated = associateByIds(submaps);
  for (const Method method : {Method::kSequential, Method::kSequentialIterated, Method::kDenseFilter}) {
    int calls = 0;
    const Joining stopped =
        joinBy(by(method), associated.problem, [&](double) { return ++calls < static_cast<int>(kFused); });
    EXPECT_EQ(stopped.result.status, JoinStatus::kIterationLimit);
    EXPECT_THAT(stopped.result.reason, HasSubstr("stopped after 5 of 12 submaps"));
    const Joining fused = joinBy(by(method), part.problem, {});
    ASSERT_EQ(stopped.state.ends.size(), submaps.size());
    for (std::size_t k = 0; k < kFused; ++k) {
      EXPECT_LT((stopped.state.ends[k] - fused.state.ends[k]).norm(), 1e-9);
      EXPECT_LT((stopped.covariances.ends[k] - fused.covariances.ends[k]).norm(), 1e-12);
    }
    for (std::size_t k = kFused; k < submaps.size(); ++k) {
      const Pose chain = compose(stopped.state.ends[k - 1], Pose(associated.observations[k].z.head<3>()));
      EXPECT_LT((stopped.state.ends[k] - chain).norm(), 1e-12);
      EXPECT_GT(stopped.covariances.ends[k](2, 2), stopped.covariances.ends[k - 1](2, 2));
    }
    for (const auto& covariance : stopped.covariances.landmarks) EXPECT_GT(covariance.determinant(), 0);
  }
}

TEST_F(EifTreePlugin, AStoppedIncrementalJoiningBeginsAnew) {
  const LandmarkSubmaps all = simulateLandmarks({});
  const auto at_work = joiner->incremental();
  at_work->join({all.begin(), all.begin() + 7}, [](double, const std::string&) { return false; });
  EXPECT_EQ(at_work->join(all, {}).objective, joiner->join(all, {}).objective);
}

TEST_F(EifTreePlugin, AStoppedAssociationKeepsWhatWasJoined) {
  parameters.set("eif_tree", "association", "jcbb");
  const auto submaps = simulateLandmarks({});
  int calls = 0;
  const JoinedLandmarks joined =
      joiner->join(submaps, [&](double, const std::string&) { return ++calls < 4; });
  EXPECT_EQ(joined.status, JoinStatus::kIterationLimit);
  EXPECT_THAT(joined.reason, HasSubstr("stopped after 4 of 12 submaps"));
  ASSERT_EQ(joined.frames.size(), submaps.size() + 1);
  EXPECT_FALSE(joined.landmarks.empty());
  std::size_t features = 0;
  for (const auto& submap : submaps) features += submap->features.size();
  ASSERT_EQ(joined.associations.size(), features);
  for (const auto& a : joined.associations) {
    const bool left_out = a.submap >= 4;
    EXPECT_TRUE(!left_out || a.kind == FeatureAssociation::Kind::kDropped) << a.submap;
  }
  for (std::size_t k = 5; k < joined.frames.size(); ++k)
    EXPECT_GT(joined.frames[k].cov(2, 2), joined.frames[k - 1].cov(2, 2));
}

}  // namespace
}  // namespace submap_slam
