/** Submaps that cannot be joined, or not all of them: a clear result or a clear error. */
#include <submap_slam/core/errors.h>

#include "grid_joining_fixture.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using testing::renderSubmap;

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

}  // namespace
}  // namespace submap_slam
