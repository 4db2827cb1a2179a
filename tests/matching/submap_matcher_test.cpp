#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>
#include <submap_slam/matching/submap_matcher.h>

#include <cmath>

#include "../mapping/mapped_log.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Two laps of the room; the log is cut into submaps of 6 m. */
struct RoomLaps {
  SimulatedLog log = simulateRoute(roomWorld(), 40, {}, 3);
  GridSubmaps submaps;

  RoomLaps() {
    StretchParams params;
    params.max_distance = 6;
    submaps = mapLog(log.frames, {}, 1, params);
  }
  TPose2D trueRelation(std::size_t a, std::size_t b) const {
    return log.truth[submaps[b]->first_frame].pose - log.truth[submaps[a]->first_frame].pose;
  }
};

const RoomLaps& room() {
  static const RoomLaps laps;
  return laps;
}

TEST(SubmapMatcher, FindsWhereSubmapsBelongFromFarOff) {
  const auto& submaps = room().submaps;
  ASSERT_GE(submaps.size(), 4u);
  const SubmapMatcher matcher(*submaps[0], {});
  for (std::size_t k = 1; k < submaps.size(); ++k) {
    const TPose2D truth = room().trueRelation(0, k);
    if (std::hypot(truth.x, truth.y) > 5) continue;  // they share too little
    const PoseWindow window{{truth.x + 1.7, truth.y - 2.1, truth.phi + 0.3}, 3, 0.5};
    const MatchableSubmap other = matchable(*submaps[k]);
    const auto match = matcher.match(other, window);
    ASSERT_TRUE(match) << k;
    EXPECT_NEAR(match->T_ref_other.x, truth.x, 0.03) << k;
    EXPECT_NEAR(match->T_ref_other.y, truth.y, 0.03) << k;
    EXPECT_NEAR(mrpt::math::wrapToPi(match->T_ref_other.phi - truth.phi), 0, 0.01) << k;
    EXPECT_GT(match->agreement, 0.85) << k;
    EXPECT_GT(match->hit_share, 0.5) << k;
    EXPECT_EQ(matcher.rivalScore(other, window, *match), 0) << k;
  }
}

TEST(SubmapMatcher, UnloadedSubmapsMatchAlike) {
  const auto& submaps = room().submaps;
  const PoseWindow window{room().trueRelation(0, 2), 1.2, 0.2};
  const auto loaded = SubmapMatcher(*submaps[0], {}).match(matchable(*submaps[2]), window);
  submaps[0]->unload();
  submaps[2]->unload();
  const auto unloaded = SubmapMatcher(*submaps[0], {}).match(matchable(*submaps[2]), window);
  submaps[0]->load();
  submaps[2]->load();
  ASSERT_TRUE(loaded && unloaded);
  EXPECT_EQ(loaded->T_ref_other, unloaded->T_ref_other);
}

TEST(SubmapMatcher, ASubmapWithoutScansMatchesNothing) {
  GridSubmap empty;
  empty.nodes.resize(3);
  const auto& other = *room().submaps[0];
  EXPECT_FALSE(SubmapMatcher(empty, {}).match(matchable(other), {{}, 2, 0.3}));
  EXPECT_FALSE(SubmapMatcher(other, {}).match(matchable(empty), {{}, 2, 0.3}));
}

}  // namespace
}  // namespace submap_slam
