/** What the user changes by hand (--edits) reaches the results. */
#include <algorithm>
#include <cmath>
#include <sstream>

#include "cli_fixture.h"

namespace submap_slam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

struct Vertex {
  double x = NAN, y = NAN, phi = NAN;
};

class EditsCliTest : public CliTest {
 protected:
  void SetUp() override { succeed({"build", log("room.rawlog"), "-o", path("s.rawlog"), "-q"}); }

  /** Joins with these edits into a folder of its own. */
  Outcome join(const std::string& edits, const std::string& folder, const std::string& chain) const {
    writeFile(path("edits.txt"), edits);
    return run({"join", path("s.rawlog"), "-o", path(folder), "-q", "--edits", path("edits.txt"), "--set",
                "joining.chain=" + chain});
  }

  std::string result(const std::string& folder, const std::string& file) const {
    return contentOf(path(folder + "/" + file));
  }

  /** The frame of a submap in graph.g2o. */
  Vertex frameOf(const std::string& folder, int submap) const {
    std::istringstream graph(result(folder, "graph.g2o"));
    std::string word;
    int id = -1;
    Vertex vertex;
    while (graph >> word >> id >> vertex.x >> vertex.y >> vertex.phi)
      if (word == "VERTEX_SE2" && id == submap) return vertex;
    return {};
  }

  /** Pixels of map.pgm that are not unknown. */
  long knownPixels(const std::string& folder) const {
    const std::string pgm = result(folder, "map.pgm");
    std::istringstream header(pgm);
    std::string magic;
    std::size_t columns = 0, rows = 0;
    header >> magic >> columns >> rows;
    EXPECT_EQ(magic, "P5");
    return std::count_if(pgm.end() - static_cast<std::ptrdiff_t>(columns * rows), pgm.end(),
                         [](char pixel) { return static_cast<unsigned char>(pixel) != 205; });
  }
};

const std::string kGraph = "odometry_pose_graph", kDefault = "odometry_pose_graph,grid_gauss_newton";

TEST_F(EditsCliTest, ARejectedLoopIsListedAndNotUsed) {
  ASSERT_EQ(join("", "before", kGraph).exit_code, 0);
  ASSERT_THAT(result("before", "constraints.csv"), HasSubstr("\n6,0,inter,1,"));
  EXPECT_THAT(result("before", "graph.g2o"), HasSubstr("\nEDGE_SE2 6 0 "));

  ASSERT_EQ(join("reject 0 6  # see the photo", "after", kGraph).exit_code, 0);
  const std::string constraints = result("after", "constraints.csv");
  EXPECT_THAT(constraints, HasSubstr("\n6,0,inter,0,"));
  EXPECT_THAT(constraints, HasSubstr(",\"rejected by hand\"\n"));
  EXPECT_THAT(result("after", "graph.g2o"), Not(HasSubstr("\nEDGE_SE2 6 0 ")));
  EXPECT_THAT(result("after", "log.txt"), HasSubstr("by hand: reject 0 6\n"));
}

TEST_F(EditsCliTest, AFixedFrameIsWhereTheUserSays) {
  for (const std::string& chain : {kGraph, kDefault}) {
    ASSERT_EQ(join("", "before", chain).exit_code, 0);
    const Vertex before = frameOf("before", 6);
    ASSERT_EQ(join("fix 6 " + std::to_string(before.x + 0.4) + " " + std::to_string(before.y) + " " +
                       std::to_string(before.phi),
                   "after", chain)
                  .exit_code,
              0);
    const Vertex after = frameOf("after", 6);
    EXPECT_NEAR(after.x, before.x + 0.4, 0.02) << chain;
    EXPECT_NEAR(after.y, before.y, 0.02) << chain;
    EXPECT_THAT(result("after", "constraints.csv"), HasSubstr(",\"fixed by hand\"\n"));
    fs::remove_all(path("before"));
    fs::remove_all(path("after"));
  }
}

TEST_F(EditsCliTest, AnAddedConstraintMovesTheFrame) {
  ASSERT_EQ(join("add 0 4 3.0 -2.0 0.5 0.001 0.001", "after", kGraph).exit_code, 0);
  const Vertex frame = frameOf("after", 4);
  EXPECT_NEAR(frame.x, 3, 0.05);
  EXPECT_NEAR(frame.y, -2, 0.05);
  EXPECT_NEAR(frame.phi, 0.5, 0.02);
  EXPECT_THAT(result("after", "constraints.csv"),
              HasSubstr("\n0,4,inter,1,3.0000,-2.0000,0.50000,0.0010,0.0010,0.00100,\"added by hand\"\n"));
}

TEST_F(EditsCliTest, AMaskedSubmapLeavesTheMapButNotTheTrajectory) {
  ASSERT_EQ(join("", "before", "").exit_code, 0);
  const Outcome masked = join("mask 2\n", "after", "");
  ASSERT_EQ(masked.exit_code, 0);
  EXPECT_EQ(masked.err, "") << "an empty chain is no reason for a warning";
  EXPECT_LT(knownPixels("after"), knownPixels("before"));
  EXPECT_EQ(result("after", "trajectory.tum"), result("before", "trajectory.tum"));

  ASSERT_EQ(join("mask 2\n", "joined", kDefault).exit_code, 0);
  std::istringstream constraints(result("joined", "constraints.csv"));
  for (std::string line; std::getline(constraints, line);)
    if (line.find(",inter,") != std::string::npos) {
      EXPECT_NE(line.substr(0, 2), "2,") << line;
      EXPECT_EQ(line.find(",2,inter"), std::string::npos) << line;
    }
}

TEST_F(EditsCliTest, SaysThatNobodyUsesTheEdits) {
  const Outcome outcome = join("reject 6 0", "out", "");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("edits.txt: only masks count, [joining] chain names no joiner"));
}

TEST_F(EditsCliTest, WrongLinesAreRefusedBeforeAnythingIsWritten) {
  expectRefused(join("mask 1\nrejct 1 3", "out", kGraph), "edits.txt:2: unknown word 'rejct'; expected");
  expectRefused(join("mask 77", "out", kGraph), "edits.txt:1: there is no submap 77; expected 0 to 6");
  expectRefused(join("fix 3 0 0 north", "out", kGraph), "edits.txt:1: 'north' is not a number");
  expectRefused(join("mask 3\nmask 3", "out", kGraph), "edits.txt:2: 'mask 3': line 1 said so");
  expectRefused(run({"join", path("s.rawlog"), "-o", path("out"), "--edits", path("none.txt")}),
                "none.txt: no such edits file");
  EXPECT_TRUE(!fs::exists(path("out")) || fs::is_empty(path("out")));
}

TEST_F(EditsCliTest, MapTakesThemToo) {
  const auto map = [this](const std::string& edits) {
    writeFile(path("edits.txt"), edits);
    return run({"map", log("room.rawlog"), "-o", path("map"), "-q", "--edits", path("edits.txt")});
  };
  expectRefused(map("mask x"), "edits.txt:1: 'x' is not the id of a submap");
  EXPECT_FALSE(fs::exists(path("map"))) << "refused before hours of mapping";
  expectRefused(map("mask 77"), "edits.txt:1: there is no submap 77");
  EXPECT_EQ(map("mask 2\nreject 6 0").exit_code, 0) << "the submaps that are there are used";

  ASSERT_EQ(join("mask 2\nreject 6 0", "joined", kDefault).exit_code, 0);
  for (const char* file : {"trajectory.tum", "map.pgm", "constraints.csv"})
    EXPECT_TRUE(result("map", file) == result("joined", file)) << file;
}

}  // namespace
}  // namespace submap_slam::testing
