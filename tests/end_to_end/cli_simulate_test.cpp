/** `simulate` writes logs with truth, the same for the same seed. */
#include <sstream>

#include "cli_fixture.h"

namespace submap_slam::testing {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class SimulateTest : public CliTest {
 protected:
  /** A short drive with few beams. */
  Arguments simulate(const std::string& prefix, const Arguments& extra = {}) const {
    Arguments arguments{
        "simulate", "non_convex",         "-o", path(prefix), "--set", "simulation.max_scans=40",
        "--set",    "simulation.beams=90"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    return arguments;
  }

  std::string content(const std::string& file) const { return contentOf(path(file)); }
};

TEST_F(SimulateTest, HelpHasAnExample) {
  EXPECT_THAT(succeed({"simulate", "--help"}).out, HasSubstr("Example: submap-slam simulate "));
}

TEST_F(SimulateTest, WritesLogTruthOdometryAndParameters) {
  EXPECT_THAT(succeed(simulate("a")).err, HasSubstr("40 scans"));
  EXPECT_EQ(lines(content("a.truth.tum")), 1u + 40u) << "a heading and one line for each scan";
  EXPECT_EQ(lines(content("a.odometry.tum")), 1u + 40u);
  EXPECT_THAT(content("a.ini"), HasSubstr("beams = 90\n"));
  EXPECT_THAT(succeed({"check", path("a.rawlog")}).out, HasSubstr("40"));
}

TEST_F(SimulateTest, GivesTheSameBytesForTheSameSeedOnly) {
  succeed(simulate("a", {"--seed", "4"}));
  succeed(simulate("b", {"--seed", "4"}));
  succeed(simulate("c", {"--seed", "5"}));
  for (const std::string ending : {".rawlog", ".truth.tum", ".odometry.tum", ".ini"})
    EXPECT_TRUE(content("a" + ending) == content("b" + ending)) << ending;
  EXPECT_TRUE(content("a.truth.tum") == content("c.truth.tum")) << "noise does not move the robot";
  EXPECT_FALSE(content("a.rawlog") == content("c.rawlog"));
  EXPECT_FALSE(content("a.odometry.tum") == content("c.odometry.tum"));
}

TEST_F(SimulateTest, TakesUpTheParametersThatItWrote) {
  succeed(simulate("a"));
  succeed({"simulate", "non_convex", "-o", path("b"), "-c", path("a.ini")});
  EXPECT_TRUE(content("a.rawlog") == content("b.rawlog"));
}

TEST_F(SimulateTest, WritesBothFormsOfRawlog) {
  succeed(simulate("a"));
  succeed(simulate("b", {"--actions"}));
  EXPECT_FALSE(content("a.rawlog") == content("b.rawlog"));
  EXPECT_THAT(succeed({"check", path("b.rawlog")}).out, HasSubstr("40"));
}

TEST_F(SimulateTest, TellsMapWhatTheCarIsLike) {
  const Outcome outcome = succeed({"simulate", "landmarks_block", "-o", path("a"), "--set",
                                   "simulation.max_scans=100", "--set", "simulation.wheel_base=3.5"});
  EXPECT_THAT(outcome.err, HasSubstr("submap-slam map " + path("a.map.ini") + " " + path("a.rawlog")));
  succeed({"map", path("a.map.ini"), path("a.rawlog"), "-o", path("out"), "-q"});
  const std::string effective = content("out/config.ini");
  for (const char* setting : {"model = ackermann\n", "wheel_base = 3.5\n", "encoder_offset = 0\n",
                              "sigma_velocity = 0.1\n", "stabilising_xy = 0\n"})
    EXPECT_THAT(effective, HasSubstr(setting));
}

TEST_F(SimulateTest, RefusesWhatItCannotDo) {
  const std::string out = path("out");
  expectRefused(run({"simulate", "-o", out}), "world is required");
  expectRefused(run({"simulate", "moon", "-o", out}), "expected one of room, corridor");
  expectRefused(run({"simulate", "moon", "-o", out}), "landmarks_a, landmarks_b, landmarks_block");
  expectRefused(run(simulate("out", {"--set", "simulation.beam=9"})), "did you mean [simulation] beams?");
  expectRefused(run(simulate("out", {"--set", "simulation.beams=1"})), "beams");
  expectRefused(run(simulate("out", {"-c", path("missing.ini")})), "missing.ini: no such ini file");
  for (const char* seed : {"-1", "1.5", "two", ""})
    expectRefused(run(simulate("out", {"--seed", seed})),
                  "--seed: '" + std::string(seed) + "' is not a whole number, 0 or more");
  expectRefused(run(simulate("out", {"--seed", "18446744073709551616"})), "is too large");
  EXPECT_FALSE(fs::exists(out + ".rawlog"));

  writeFile(path("out.truth.tum"), "precious");
  expectRefused(run(simulate("out")), "--overwrite");
  EXPECT_EQ(content("out.truth.tum"), "precious");
  succeed(simulate("out", {"--overwrite"}));
  EXPECT_NE(content("out.truth.tum"), "precious");

  const Outcome no_folder = run(simulate("no/such/folder/a"));
  EXPECT_EQ(no_folder.exit_code, 1);
  EXPECT_THAT(no_folder.err, HasSubstr("no/such/folder"));
}

TEST_F(SimulateTest, EveryKeyIsDocumented) {
  succeed(simulate("a"));
  const std::string page = contentOf(SUBMAP_SLAM_SOURCE_DIR "/docs/experiments.md");
  std::istringstream ini(content("a.ini"));
  int keys = 0;
  for (std::string line; std::getline(ini, line);) {
    if (line.empty() || line[0] == '#' || line[0] == '[') continue;
    ++keys;
    EXPECT_THAT(page, HasSubstr("`" + line.substr(0, line.find(' ')) + "`"));
  }
  EXPECT_GT(keys, 15);
}

}  // namespace
}  // namespace submap_slam::testing
