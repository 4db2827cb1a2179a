/** What the global map is made from. */
#include "cli_fixture.h"

namespace submap_slam::testing {
namespace {

using MapSourceTest = CliTest;

TEST_F(MapSourceTest, IsChosenByTheUserAndLeavesThePosesAlone) {
  succeed(quickly({"map", log("room.rawlog"), "-o", path("scans")}));
  const Arguments join{
      "join",  path("scans/submaps.rawlog"), "-o", path("submaps"), "-q", "--set", "joining.chain=",
      "--set", "joining.map=submaps"};
  succeed(join);
  EXPECT_EQ(contentOf(path("scans/trajectory.tum")), contentOf(path("submaps/trajectory.tum")));
  EXPECT_FALSE(contentOf(path("scans/map.pgm")) == contentOf(path("submaps/map.pgm")));
  expectRefused(run({"join", path("scans/submaps.rawlog"), "-o", path("no"), "--set", "joining.map=magic"}),
                "expected one of 'scans', 'submaps'");
}

}  // namespace
}  // namespace submap_slam::testing
