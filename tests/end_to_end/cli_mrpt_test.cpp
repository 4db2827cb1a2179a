/** MRPT's own programs understand the results. */
#include "cli_fixture.h"

namespace submap_slam::testing {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class MrptProgramsTest : public CliTest {
 protected:
  static std::string typesLibrary() { return SUBMAP_SLAM_BINARY_DIR "/lib/libsubmap-types.so"; }
  bool available(const std::string& other) const { return runOther(other, {"--help"}).exit_code != 127; }
};

TEST_F(MrptProgramsTest, RawlogEditListsTheSubmaps) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a library with a sanitizer cannot be loaded into a program without";
#endif
  if (!available("rawlog-edit")) GTEST_SKIP() << "rawlog-edit is not installed (package mrpt-apps)";
  succeed(quickly({"build", log("room.rawlog"), "-o", path("s.rawlog")}));
  const std::string last_row = succeed({"info", path("s.rawlog")}).out;
  const auto submaps = lines(last_row) - 2;  // without heading and totals

  const Outcome info = runOther("rawlog-edit", {"-i", path("s.rawlog"), "-p", typesLibrary(), "--info"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("Overall number of objects         : " + std::to_string(submaps) + "\n"));
}

TEST_F(MrptProgramsTest, RawlogEditDescribesExportsAndFiltersSubmaps) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a library with a sanitizer cannot be loaded into a program without";
#endif
  if (!available("rawlog-edit")) GTEST_SKIP() << "rawlog-edit is not installed (package mrpt-apps)";
  fs::create_directory(path("logs"));
  succeed(quickly({"build", log("room.rawlog"), "-o", path("logs/s.rawlog")}));
  const auto edit = [this](Arguments arguments) {
    arguments.insert(arguments.begin(), {"-i", path("logs/s.rawlog"), "-p", typesLibrary()});
    const Outcome outcome = runOther("rawlog-edit", arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.out;
  };
  const std::string text = edit({"--describe"});
  for (const char* part :
       {"Grid submap 0", "frames of the log", "nodes   ", "observed, ", " hits\n", "its 1-sigma"})
    EXPECT_THAT(text, HasSubstr(part));

  edit({"--export-txt"});  // "logs" + "s_SUBMAP.txt": rawlog-edit leaves out the slash
  std::string table;
  for (const auto& entry : fs::directory_iterator(path("")))
    if (entry.path().extension() == ".txt") table = contentOf(entry.path());
  EXPECT_THAT(table, HasSubstr("end_sigma_phi_rad"));
  EXPECT_EQ(lines(table), lines(succeed({"info", path("logs/s.rawlog")}).out) - 1);  // no totals

  edit({"--keep-label", "SUBMAP", "-o", path("kept.rawlog")});
  EXPECT_EQ(succeed({"info", path("kept.rawlog")}).out, succeed({"info", path("logs/s.rawlog")}).out);
}

TEST_F(MrptProgramsTest, SubmapsOfAnOlderVersionAreStillOpened) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a library with a sanitizer cannot be loaded into a program without";
#endif
  if (!available("rawlog-edit")) GTEST_SKIP() << "rawlog-edit is not installed (package mrpt-apps)";
  const std::string old = SUBMAP_SLAM_SOURCE_DIR "/tests/rawlog/data/submaps_version_0.rawlog";
  const Outcome outcome = runOther("rawlog-edit", {"-i", old, "-p", typesLibrary(), "--describe"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Grid submap"));
}

TEST_F(MrptProgramsTest, JoinedMapIsOpenedWithoutAnyPlugin) {
  if (!available("rawlog-edit")) GTEST_SKIP() << "rawlog-edit is not installed (package mrpt-apps)";
  succeed(quickly({"map", log("room.rawlog"), "-o", path("out")}));
  const Outcome outcome = runOther("rawlog-edit", {"-i", path("out/map.rawlog"), "--info"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Overall number of objects         : 1\n"));
}

TEST_F(MrptProgramsTest, RosMapIsLoaded) {
  if (!available("ros-map-yaml2mrpt"))
    GTEST_SKIP() << "ros-map-yaml2mrpt is not installed (package mrpt-apps)";
  succeed(quickly({"map", log("room.rawlog"), "-o", path("out")}));
  const Outcome outcome =
      runOther("ros-map-yaml2mrpt", {"-i", path("out/map.yaml"), "-d", path("output"), "-w"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(path("output/map.gridmap")) || fs::exists(path("output/map.gridmap.gz")));
}

TEST_F(MrptProgramsTest, LogWithoutOdometryIsMappedWithAWarning) {
  if (!available("rawlog-edit")) GTEST_SKIP() << "rawlog-edit is not installed (package mrpt-apps)";
  runOther("rawlog-edit",
           {"-i", log("room.rawlog"), "-o", path("scans.rawlog"), "--remove-label", "ODOMETRY"});
  const Outcome outcome = succeed(quickly({"map", path("scans.rawlog"), "-o", path("out")}));
  EXPECT_THAT(outcome.err, HasSubstr("submap-slam: warning: There is no odometry"));
  EXPECT_GT(lines(contentOf(path("out/trajectory.tum"))), 90u);
}

}  // namespace
}  // namespace submap_slam::testing
