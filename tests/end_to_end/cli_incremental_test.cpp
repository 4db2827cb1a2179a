/** Maps while submaps are being built (map --incremental). */
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "cli_fixture.h"

namespace submap_slam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;
namespace fs = std::filesystem;

/** Whole from its signature to its last chunk. */
void expectPng(const std::string& file) {
  const std::string bytes = contentOf(file);
  EXPECT_THAT(bytes, StartsWith("\x89PNG\r\n\x1a\n")) << file;
  EXPECT_THAT(bytes, EndsWith(std::string("\0\0\0\0IEND\xae\x42\x60\x82", 12))) << file;
}

using Table = std::vector<std::vector<std::string>>;

/** The cells of a table, line by line. */
Table cellsOf(const std::string& file) {
  Table cells;
  std::istringstream text(contentOf(file));
  for (std::string line; std::getline(text, line);) {
    cells.emplace_back();
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, ',');) cells.back().push_back(word);
  }
  return cells;
}

class IncrementalTest : public CliTest {
 protected:
  Arguments map(const std::string& folder, const Arguments& more = {}) const {
    Arguments arguments{"map", log("room.rawlog"), "-o", path(folder), "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  /** All that does not say how the run went. */
  std::map<std::string, std::string> results(const std::string& folder) const {
    auto files = contentsOf(path(folder));
    for (const char* name : {"metrics.json", "config.ini", "updates.csv", "report.html"}) files.erase(name);
    return files;
  }

  Table updates(const std::string& folder) const { return cellsOf(path(folder + "/updates.csv")); }

  /** First column of updates.csv. */
  std::vector<std::string> submapsAtUpdates(const std::string& folder) const {
    std::vector<std::string> submaps;
    for (const auto& line : updates(folder)) submaps.push_back(line.front());
    return submaps;
  }

  /** Starts the run and sends the signal when `updates` maps are there. */
  Outcome signalAfter(std::size_t updates, const Arguments& arguments, const std::string& folder,
                      int number) const {
    Process process = start(arguments);
    while (process.running() && lines(contentOf(path(folder + "/updates.csv"))) < updates + 1)
      std::this_thread::yield();
    process.signal(number);
    return process.wait();
  }
};

TEST_F(IncrementalTest, TheFinalResultIsThatOfARunWithout) {
  succeed(map("whole"));
  for (const std::string threads : {"1", "3"}) {
    succeed(map(threads, {"--incremental", "--threads", threads}));
    EXPECT_TRUE(results(threads) == results("whole")) << threads << " threads";
  }
}

/** Also those that speak of submaps which are not there yet when the first maps are made. */
TEST_F(IncrementalTest, EditsCountAsInARunWithout) {
  writeFile(path("edits.txt"), "reject 0 5\nmask 0\nmask 3\nfix 6 5.5 4.5 -3.1\n");
  succeed(map("whole", {"--edits", path("edits.txt")}));
  succeed(map("incremental", {"--edits", path("edits.txt"), "--incremental"}));
  EXPECT_TRUE(results("incremental") == results("whole"));
  EXPECT_THAT(submapsAtUpdates("incremental"), ElementsAre("submaps", "2", "3", "4", "5", "6", "7"));
}

TEST_F(IncrementalTest, ListsEveryUpdate) {
  succeed(map("out", {"--incremental"}));
  const Table table = updates("out");
  EXPECT_THAT(table.front(), ElementsAre("submaps", "nodes", "constraints_accepted", "constraints_rejected",
                                         "objective", "status", "read_s", "odometry_pose_graph_s",
                                         "grid_gauss_newton_s", "fuse_s", "write_s", "update_s"));
  EXPECT_THAT(submapsAtUpdates("out"), ElementsAre("submaps", "1", "2", "3", "4", "5", "6", "7"));
  for (const auto& line : table) EXPECT_EQ(line.size(), table.front().size());
  EXPECT_EQ(table[1][5], "nothing to join");

  const auto metrics = nlohmann::json::parse(contentOf(path("out/metrics.json")));
  EXPECT_EQ(table.back()[1], metrics["frames"].dump());
  EXPECT_EQ(table.back()[2], metrics["constraints_accepted"].dump());
  EXPECT_EQ(table.back()[4], metrics["objective"].dump());
}

TEST_F(IncrementalTest, UpdatesCanBeRarer) {
  succeed(map("out", {"--set", "joining.incremental=true", "--set", "joining.update_growth=2"}));
  EXPECT_THAT(submapsAtUpdates("out"), ElementsAre("submaps", "1", "2", "4"));
  expectRefused(run(map("no", {"--set", "joining.update_growth=0.5"})), "update_growth");
}

TEST_F(IncrementalTest, AKilledRunLeavesAMapAndGoesOn) {
  succeed(map("whole", {"--incremental"}));
  for (const std::size_t after : {1u, 3u, 5u}) {
    const std::string folder = "killed" + std::to_string(after);
    const Arguments arguments = map(folder, {"--incremental", "--threads", "1"});
    ASSERT_EQ(signalAfter(after, arguments, folder, SIGKILL).exit_code, -SIGKILL);
    expectPng(path(folder + "/map.png"));
    EXPECT_THAT(contentOf(path(folder + "/graph.g2o")), StartsWith("VERTEX_SE2 0 "));
    EXPECT_GE(lines(contentOf(path(folder + "/trajectory.tum"))), std::stoul(updates(folder).at(after)[1]));
    succeed(arguments);
    const auto submaps = submapsAtUpdates(folder);
    EXPECT_TRUE(std::is_sorted(submaps.begin() + 1, submaps.end()));
    EXPECT_EQ(submaps.back(), "7");
    EXPECT_TRUE(results(folder) == results("whole"));
  }
}

TEST_F(IncrementalTest, AStoppedRunSaysWhereItsMapIs) {
  const Outcome outcome = signalAfter(
      2, {"map", log("room.rawlog"), "-o", path("out"), "--incremental", "--threads", "1"}, "out", SIGINT);
  ASSERT_EQ(outcome.exit_code, 130);
  EXPECT_THAT(outcome.err, HasSubstr("map of 2 submaps ("));
  EXPECT_THAT(outcome.err, HasSubstr(" submaps: " + path("out/map.png")));
  expectPng(path("out/map.png"));
}

TEST_F(IncrementalTest, OneSubmapIsAMapToo) {
  const Arguments one{"--to", "5s"};
  succeed(map("whole", one));
  succeed(map("out", {"--to", "5s", "--incremental"}));
  EXPECT_THAT(submapsAtUpdates("out"), ElementsAre("submaps", "1"));
  EXPECT_TRUE(results("out") == results("whole"));
}

TEST_F(IncrementalTest, GoesOnWhereAJoinerFails) {
  const Outcome outcome = succeed(
      map("out", {"--incremental", "-p", MOODY_JOINER, "--set", "joining.chain=odometry_pose_graph,moody"}));
  EXPECT_THAT(outcome.err, HasSubstr("warning: no map of the first 2 submaps: not these two\n"));
  EXPECT_THAT(outcome.err, HasSubstr("warning: moody: failed (not in the mood)"));
  EXPECT_THAT(submapsAtUpdates("out"), ElementsAre("submaps", "1", "3", "4", "5", "6", "7"));
  EXPECT_EQ(updates("out")[2][5], "failed");
}

TEST_F(IncrementalTest, IsForMapOnly) {
  expectRefused(run({"build", log("room.rawlog"), "-o", path("s.rawlog"), "--incremental"}), "--incremental");
  expectRefused(run({"join", path("s.rawlog"), "-o", path("out"), "--incremental"}), "--incremental");
}

}  // namespace
}  // namespace submap_slam::testing
