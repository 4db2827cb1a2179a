#include <gmock/gmock.h>
#include <submap_slam/core/errors.h>

#include <cmath>

#include "landmark_joining_fixture.h"
#include "landmark_world.h"

namespace submap_slam {
namespace {

using ::testing::AllOf;
using testing::EifTreePlugin;
using ::testing::HasSubstr;
using testing::LandmarkWorldOptions;
using testing::simulateLandmarks;
using testing::submapOf;

TEST_F(EifTreePlugin, JoiningAsSubmapsComeGivesTheSameBits) {
  LandmarkWorldOptions options;
  options.submaps = 21;
  const LandmarkSubmaps all = simulateLandmarks(options);
  const auto at_work = joiner->incremental();
  for (const std::ptrdiff_t count : {1, 2, 3, 8, 13, 20, 21}) {
    const LandmarkSubmaps first(all.begin(), all.begin() + count);
    const JoinedLandmarks step = at_work->join(first, {}), at_once = joiner->join(first, {});
    ASSERT_EQ(step.frames.size(), at_once.frames.size());
    for (std::size_t k = 0; k < step.frames.size(); ++k)
      EXPECT_EQ(step.frames[k].mean.asTPose(), at_once.frames[k].mean.asTPose()) << count << " " << k;
    EXPECT_EQ(step.objective, at_once.objective) << count;
  }
}

TEST_F(EifTreePlugin, SubmapsWithoutIdsAreMatchedByPosition) {
  LandmarkSubmaps submaps = simulateLandmarks({});
  const std::size_t landmarks = joiner->join(submaps, {}).landmarks.size();
  for (const auto& submap : submaps) {
    submap->ids_known = false;
    for (std::size_t i = 0; i < submap->features.size(); ++i)
      submap->features[i].id = static_cast<uint32_t>(i + 1);
  }
  const JoinedLandmarks joined = joiner->join(submaps, {});
  EXPECT_FALSE(joined.association_known);
  EXPECT_EQ(joined.landmarks.size(), landmarks);
}

TEST_F(EifTreePlugin, GivesFramesAndLandmarksWithTheirCovariances) {
  auto submaps = simulateLandmarks({});
  for (auto& feature : submaps[0]->features) feature.hits = 10;
  const JoinedLandmarks joined = joiner->join(submaps, {});
  ASSERT_EQ(joined.frames.size(), submaps.size() + 1);
  EXPECT_EQ(joined.frames[0].mean.norm(), 0);
  EXPECT_EQ(joined.frames[0].cov(0, 0), 0);
  EXPECT_NEAR(joined.frames.back().mean.norm(), 0, 0.2) << "the drive ends where it began";
  EXPECT_GT(joined.frames[6].cov(0, 0), joined.frames[1].cov(0, 0));
  EXPECT_TRUE(joined.association_known);
  std::size_t features = 0, hits = 0, joined_hits = 0;
  for (const auto& submap : submaps)
    for (const auto& feature : submap->features) ++features, hits += feature.hits;
  for (const auto& landmark : joined.landmarks) joined_hits += landmark.hits;
  EXPECT_EQ(joined.associations.size(), features);
  EXPECT_EQ(joined_hits, hits);
}

TEST_F(EifTreePlugin, ContradictoryIdsEndInAResultThatIsFinite) {
  auto submaps = simulateLandmarks({});
  std::swap(submaps[3]->features.front().id, submaps[3]->features.back().id);
  const double consistent = joiner->join(simulateLandmarks({}), {}).objective;
  const JoinedLandmarks joined = joiner->join(submaps, {});
  EXPECT_TRUE(std::isfinite(joined.objective));
  EXPECT_GT(joined.objective, 10 * consistent);
}

TEST_F(EifTreePlugin, DegenerateSequencesHaveAResultOrAnErrorWhateverTheAssociation) {
  for (const char* association : {"known", "nearest_neighbour", "jcbb"}) {
    SCOPED_TRACE(association);
    parameters.set("eif_tree", "association", association);
    const auto one = submapOf({1, 0, 0}, {{7, 2, 1, 1}}, 0.01), none = submapOf({1, 0, 0}, {}, 0.01);
    EXPECT_EQ(joiner->join({one}, {}).landmarks.size(), 1u);
    EXPECT_EQ(joiner->join({one}, {}).status, JoinStatus::kConverged);
    EXPECT_EQ(joiner->join({none, none}, {}).status, JoinStatus::kConverged);
    EXPECT_EQ(joiner->join({none, one, none}, {}).landmarks.size(), 1u);

    const auto exact = submapOf({1, 0, 0}, {{7, 2, 1, 1}}, 1e-30);
    const JoinedLandmarks joined = joiner->join({exact, exact}, {});
    EXPECT_EQ(joined.status, JoinStatus::kFailed) << "beyond what a double can tell apart";
    EXPECT_THAT(joined.reason, HasSubstr("not positive definite"));
    EXPECT_EQ(joined.frames.size(), 3u);

    for (const double covariance : {0.02, -0.02, std::nan("")}) {
      const auto bad = submapOf({1, 0, 0}, {{7, 2, 1, 1}}, 0.01);
      bad->covariance(3, 4) = bad->covariance(4, 3) = covariance;
      EXPECT_THROW(joiner->join({one, bad}, {}), InputError) << covariance;
    }
  }
}

TEST_F(EifTreePlugin, EveryMethodCanBeChosen) {
  for (const char* method : {"tree_gn", "tree", "sequential", "sequential_iterated", "ekf"}) {
    parameters.set("eif_tree", "method", method);
    EXPECT_NE(joiner->join(simulateLandmarks({}), {}).status, JoinStatus::kFailed) << method;
  }
  EXPECT_THROW(parameters.set("eif_tree", "method", "magic"), ConfigError);
}

TEST_F(EifTreePlugin, EveryMethodJoinsWhatIsAssociatedByPosition) {
  const auto submaps = simulateLandmarks({});
  for (const char* method : {"tree_gn", "tree", "sequential", "sequential_iterated", "ekf"}) {
    parameters.set("eif_tree", "method", method);
    parameters.set("eif_tree", "association", "known");
    const auto by_ids = joiner->join(submaps, {});
    parameters.set("eif_tree", "association", "jcbb");
    const auto by_position = joiner->join(submaps, {});
    EXPECT_EQ(by_position.landmarks.size(), by_ids.landmarks.size()) << method;
    EXPECT_NEAR(by_position.objective, by_ids.objective, 1e-6 * by_ids.objective) << method;
    EXPECT_FALSE(by_position.association_known);
  }
}

TEST_F(EifTreePlugin, ReachesTheMinimumOfASimulatedSequence) { expectObjective("sim_8240_50.txt", 458.154); }
TEST_F(EifTreePlugin, ReachesTheMinimumOfALongSequence) {
  expectObjective("sim_35188_700.txt.gz", 10315.633);
}
TEST_F(EifTreePlugin, ReachesTheMinimumOfVictoriaPark) { expectObjective("vicpark_200.txt", 3643.435); }
TEST_F(EifTreePlugin, ReachesTheMinimumOfVictoriaParkStepByStep) {
  expectObjective("vicpark_6898.txt.gz", 9012.7196);
}

}  // namespace
}  // namespace submap_slam
