/** The report of a run, and runs side by side; what they look like is for report_test.py. */
#include <nlohmann/json.hpp>

#include "cli_fixture.h"

namespace submap_slam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

class CliCompare : public CliTest {
 protected:
  /** A run of a piece of log. */
  void map(const std::string& folder, const Arguments& more = {}) const {
    Arguments arguments = quickly({"map", log("room.rawlog"), "-o", path(folder)});
    arguments.insert(arguments.end(), more.begin(), more.end());
    succeed(arguments);
  }

  Outcome compare(const Arguments& folders) const {
    Arguments arguments{"compare"};
    arguments.insert(arguments.end(), folders.begin(), folders.end());
    arguments.insert(arguments.end(), {"-o", path("out")});
    return run(arguments);
  }
};

TEST_F(CliCompare, ReportCanBeSwitchedOff) {
  map("with");
  map("without", {"--set", "output.report=false"});
  EXPECT_TRUE(fs::exists(path("with/report.html")));
  EXPECT_FALSE(fs::exists(path("without/report.html")));
  const auto metrics = nlohmann::json::parse(contentOf(path("with/metrics.json")));
  for (const char* key : {"build_wall_s", "join_cpu_s", "write_wall_s", "report_cpu_s", "wall_s"})
    EXPECT_TRUE(metrics.contains(key)) << key;
  std::vector<std::string> stages;
  for (const auto& stage : metrics["stages"]) {
    stages.push_back(stage["name"]);
    EXPECT_GT(stage["peak_memory_mb"], 1);
    EXPECT_GE(stage["cpu_s"], 0);
  }
  EXPECT_THAT(stages, ::testing::ElementsAre("build", "fuse", "write", "report"));
}

TEST_F(CliCompare, ReportNamesNoPathOfTheMachine) {
  map("out");
  EXPECT_THAT(contentOf(path("out/report.html")), HasSubstr("\"input\":\"room.rawlog\""));
  EXPECT_THAT(contentOf(path("out/report.html")), Not(HasSubstr(folder_.string())));
}

TEST_F(CliCompare, WritesPageAndTablesAndPrintsThem) {
  map("a");
  map("b", {"--set", "mapper.key_distance=0.3"});
  map("c", {"--from", "5s"});
  const Outcome outcome = compare({path("a"), path("b") + "/", path("c")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("page: " + path("out/compare.html")));
  const auto results = contentsOf(path("out"));
  EXPECT_EQ(results.size(), 3u);
  EXPECT_EQ(results.at("compare.md"), outcome.out);
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("\\| a +\\| b +\\| c +\\|"));
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("mapper.key_distance +\\| 0.15 +\\| 0.3 +\\| 0.15 "));
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("reader.from +\\| – +\\| – +\\| 5s "));
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("common_poses +\\| – +\\| [0-9]+ +\\| [0-9]+ "));
  EXPECT_THAT(results.at("compare.csv"), ::testing::StartsWith("table,name,\"a\",\"b\",\"c\"\n"));
  EXPECT_THAT(results.at("compare.html"), HasSubstr("\"kind\":\"comparison\""));
}

TEST_F(CliCompare, FoldersOfTheSameNameAreToldApart) {
  map("x/run");
  map("y/run");
  const Outcome outcome = compare({path("x/run"), path("y/run")});
  EXPECT_THAT(outcome.out, HasSubstr(path("x/run")));
  EXPECT_THAT(outcome.out, HasSubstr("## Settings that differ\n\nnone"));
}

TEST_F(CliCompare, WhatIsNoRunIsRefusedAndNothingIsWritten) {
  map("a");
  fs::create_directory(path("empty"));
  expectRefused(compare({path("a"), path("empty")}), "empty: holds no finished run");
  expectRefused(compare({path("a"), path("missing")}), "missing: no such folder");
  expectRefused(compare({path("a"), log("room.rawlog")}), "room.rawlog: is no folder");
  EXPECT_EQ(compare({path("a")}).exit_code, 2) << "two are needed";
  writeFile(path("a/metrics.json"), "{");
  expectRefused(compare({path("a"), path("a")}), "metrics.json: is no JSON object");
  EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(CliCompare, ResultsThatExistStay) {
  map("a");
  fs::create_directory(path("out"));
  writeFile(path("out/mine.txt"), "mine");
  expectRefused(compare({path("a"), path("a")}), "is not empty");
  succeed({"compare", path("a"), path("a"), "-o", path("out"), "--overwrite", "-q"});
  EXPECT_EQ(contentOf(path("out/mine.txt")), "mine");
}

}  // namespace
}  // namespace submap_slam::testing
