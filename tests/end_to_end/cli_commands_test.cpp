/** Every subcommand of the program does what its help says. */
#include <submap_slam/rawlog/rawlog_reader.h>
#include <submap_slam/simulation/simulate.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "cli_fixture.h"

namespace submap_slam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Key;
using ::testing::StartsWith;
namespace fs = std::filesystem;

void expectSameFiles(const std::map<std::string, std::string>& a,
                     const std::map<std::string, std::string>& b) {
  EXPECT_EQ(a.size(), b.size());
  for (const auto& [name, content] : a) {
    ASSERT_THAT(b, ::testing::Contains(Key(name)));
    EXPECT_TRUE(b.at(name) == content) << name << " differs";
  }
}

TEST_F(CliTest, HelpOnEveryLevelHasAnExample) {
  EXPECT_THAT(succeed({"--help"}).out, HasSubstr("Example: submap-slam "));
  for (const char* command : {"map", "build", "join", "eval", "check", "info", "parameters"})
    EXPECT_THAT(succeed({command, "--help"}).out, HasSubstr(std::string("Example: submap-slam ") + command));
}

TEST_F(CliTest, SaysItsVersion) { EXPECT_THAT(succeed({"--version"}).out, StartsWith("submap-slam 0.")); }

TEST_F(CliTest, FindsTheInstalledJoiners) {
  EXPECT_THAT(succeed({"--list-joiners"}).out, HasSubstr("grid_gauss_newton"));
}

TEST_F(CliTest, DefaultIniEqualsTheBuiltInDefaults) {
  EXPECT_EQ(succeed({"parameters", "--ini"}).out, contentOf(SUBMAP_SLAM_SOURCE_DIR "/ini/default.ini"))
      << "make it anew: submap-slam parameters --ini > ini/default.ini";
}

TEST_F(CliTest, ReferenceDocumentsTheSectionsOfJoinersToo) {
  const std::string reference = succeed({"parameters"}).out;
  for (const char* text : {"## [reader]", "`max_distance`", "## [joining]", "## [grid_gauss_newton]"})
    EXPECT_THAT(reference, HasSubstr(text));
}

TEST_F(CliTest, MapWritesEveryResultAndSaysWhere) {
  const Outcome outcome = succeed({"map", log("room.rawlog"), "-o", path("out")});
  EXPECT_THAT(outcome.err, HasSubstr("map: " + path("out/map.png")));
  EXPECT_THAT(outcome.err, HasSubstr("100 %"));

  const auto results = contentsOf(path("out"));
  for (const char* name :
       {"map.png", "map.pgm", "map.yaml", "map.gridmap.gz", "map.simplemap", "map.3Dscene", "trajectory.tum",
        "submaps.rawlog", "submaps.csv", "graph.g2o", "metrics.json", "report.html", "config.ini", "log.txt"})
    EXPECT_THAT(results, ::testing::Contains(Key(name)));

  const auto metrics = nlohmann::json::parse(results.at("metrics.json"));
  EXPECT_EQ(metrics["scans"], 547);
  EXPECT_EQ(metrics["frames"], 547);
  EXPECT_EQ(lines(results.at("trajectory.tum")), 1u + 547u) << "a heading and one line for each frame";
  EXPECT_GT(metrics["submaps"], 3);
  EXPECT_TRUE(metrics["constraints_rejected"].is_number_unsigned());
  EXPECT_TRUE(metrics["warnings"].empty());
  for (const char* key : {"wall_s", "cpu_s", "build_wall_s", "build_cpu_s", "join_wall_s", "join_cpu_s",
                          "write_wall_s", "write_cpu_s", "peak_memory_mb", "objective", "version",
                          "match_score_mean", "nodes_per_submap", "stage_5"})
    EXPECT_TRUE(metrics.contains(key)) << key;
}

TEST_F(CliTest, LinksOfTheChainAreNoLoopClosures) {
  const Arguments chained{"map", log("room.rawlog"), "-o", path("out"), "--set", "joining.chain="};
  const Outcome outcome = succeed(chained);
  const auto metrics = nlohmann::json::parse(contentOf(path("out/metrics.json")));
  EXPECT_GT(metrics["submaps"], 3);
  EXPECT_EQ(metrics["constraints_accepted"], 0);
  EXPECT_TRUE(metrics["constraints_rejected"].is_number_unsigned());
  EXPECT_THAT(outcome.err, ::testing::Not(HasSubstr("accepted")));
  EXPECT_LT(metrics["key_nodes"], metrics["frames"]) << "every frame is a node, but not every one a key node";
  EXPECT_THAT(outcome.err, HasSubstr(metrics["key_nodes"].dump() + " key nodes, 547 frames"));
}

TEST_F(CliTest, MapOfTheRoomIsAccurate) {
  succeed({"map", log("room.rawlog"), "-o", path("out"), "-q"});
  const auto result = nlohmann::json::parse(
      succeed({"eval", path("out/trajectory.tum"), "--reference", log("room.truth.tum"), "--json"}).out);
  EXPECT_EQ(result["reference"]["absolute"]["count"], 547);
  EXPECT_LT(result["reference"]["absolute"]["translation_m"]["rmse"], 0.05);
}

TEST_F(CliTest, BuildAndJoinGiveTheResultsOfMap) {
  succeed({"map", log("loop.rawlog"), "-o", path("map"), "-q"});
  succeed({"build", log("loop.rawlog"), "-o", path("s.rawlog"), "-q"});
  succeed({"join", path("s.rawlog"), "-o", path("join"), "-q"});

  auto map = reproducibleResults(path("map")), join = reproducibleResults(path("join"));
  EXPECT_TRUE(map.at("submaps.rawlog") == contentOf(path("s.rawlog")));
  // The last two tell of the run itself: of the log here, of the file of submaps there.
  for (const char* name : {"submaps.rawlog", "submaps.rawlog.resume.json", "log.txt", "report.html"})
    map.erase(name), join.erase(name);
  expectSameFiles(map, join);
}

TEST_F(CliTest, ResultsAreTheSameBytesForAnyNumberOfThreads) {
  succeed({"map", log("loop.rawlog"), "-o", path("one"), "-q", "--threads", "1"});
  succeed({"map", log("loop.rawlog"), "-o", path("three"), "-q", "--threads", "3"});
  expectSameFiles(reproducibleResults(path("one")), reproducibleResults(path("three")));
}

TEST_F(CliTest, ResultsAreTheSameBytesForAnyMemory) {
  succeed({"map", log("loop.rawlog"), "-o", path("none"), "-q", "--memory", "130MB"});  // keeps no submap
  succeed({"join", path("none/submaps.rawlog"), "-o", path("all"), "-q", "--memory", "2GB"});
  for (const char* file : {"map.pgm", "map.png", "map.gridmap.gz", "map.simplemap", "map.3Dscene",
                           "trajectory.tum", "graph.g2o", "constraints.csv"})
    EXPECT_TRUE(contentOf(path("none/") + file) == contentOf(path("all/") + file)) << file;
  EXPECT_FALSE(std::filesystem::exists(path("all/submaps.spill")));
}

TEST_F(CliTest, RefinedNodesReachTheResults) {
  const Arguments join = quickly({"map", log("room.rawlog"), "-o"});
  const auto with = [&](const std::string& name, const std::vector<std::string>& extra) {
    Arguments arguments = join;
    arguments.insert(arguments.begin() + 3, path(name));
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    succeed(arguments);
    return contentOf(path(name + "/trajectory.tum"));
  };
  const std::string refined = with("refined", {"--set", "node_refinement.rounds=1"});
  EXPECT_THAT(contentOf(path("refined/log.txt")), HasSubstr("nodes refined, round 1"));
  EXPECT_NE(refined, with("plain", {}));
  EXPECT_EQ(refined, with("little", {"--set", "node_refinement.rounds=1", "--memory", "130MB"}));
}

TEST_F(CliTest, RefusesAnImpossibleMemory) {
  expectRefused(run({"map", log("loop.rawlog"), "-o", path("out"), "--memory", "10MB"}), "memory");
  expectRefused(run({"map", log("loop.rawlog"), "-o", path("out"), "--memory", "much"}), "--memory");
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(CliTest, TheScanMatchingMapperMapsTheRoom) {
  succeed({"map", log("room.rawlog"), "-o", path("out"), "-q", "--set", "mapper.method=scan_matching"});
  const auto metrics = nlohmann::json::parse(contentOf(path("out/metrics.json")));
  EXPECT_EQ(metrics["frames"], 547);
  EXPECT_GT(metrics["match_score_mean"], 0.8);
  const auto result = nlohmann::json::parse(
      succeed({"eval", path("out/trajectory.tum"), "--reference", log("room.truth.tum"), "--json"}).out);
  EXPECT_LT(result["reference"]["absolute"]["translation_m"]["rmse"], 0.06);
  EXPECT_THAT(contentOf(path("out/config.ini")), HasSubstr("method = scan_matching"));
}

TEST_F(CliTest, RefusesAnUnknownMapper) {
  expectRefused(run({"map", log("room.rawlog"), "-o", path("out"), "--set", "mapper.method=magic"}),
                "expected one of 'rbpf', 'scan_matching'");
}

TEST_F(CliTest, EffectiveConfigurationRepeatsTheRun) {
  succeed(quickly(
      {"map", log("room.rawlog"), "-o", path("first"), "--seed", "7", "--set", "mapper.max_range=6"}));
  EXPECT_THAT(contentOf(path("first/config.ini")), HasSubstr("seed = 7"));
  succeed({"map", path("first/config.ini"), log("room.rawlog"), "-o", path("again"), "-q"});
  expectSameFiles(reproducibleResults(path("first")), reproducibleResults(path("again")));
}

TEST_F(CliTest, ParametersChangeTheResult) {
  succeed(quickly({"build", log("room.rawlog"), "-o", path("a.rawlog")}));
  succeed(quickly({"build", log("room.rawlog"), "-o", path("b.rawlog"), "--set", "mapper.max_range=3"}));
  EXPECT_NE(contentOf(path("a.rawlog")), contentOf(path("b.rawlog")));
}

/** The same recording by a scanner mounted upside down: the beams come in the opposite direction. */
void turnOver(SimulatedLog& recording) {
  for (auto& frame : recording.frames)
    for (auto& scan : frame.scans) {
      scan->rightToLeft = !scan->rightToLeft;
      scan->sensorPose.setYawPitchRoll(scan->sensorPose.yaw(), 0, M_PI);
    }
}

TEST_F(CliTest, AScannerMountedUpsideDownGivesTheSameMap) {
  SimulatedLog recording;
  RawlogReader reader(log("room.rawlog"));
  while (auto frame = reader.next()) recording.frames.push_back(*frame);
  turnOver(recording);
  writeRawlog(path("turned.rawlog"), recording, RawlogForm::kObservations);

  succeed(quickly({"map", log("room.rawlog"), "-o", path("upright")}));
  succeed(quickly({"map", path("turned.rawlog"), "-o", path("turned")}));
  const std::string upright = contentOf(path("upright/map.pgm")), turned = contentOf(path("turned/map.pgm"));
  ASSERT_EQ(upright.size(), turned.size());
  std::size_t differ = 0;
  for (std::size_t i = 0; i < upright.size(); ++i) differ += upright[i] != turned[i];
  EXPECT_LT(differ, upright.size() / 1000) << "only rounding may differ";
}

TEST_F(CliTest, MapsALogOfActions) {
  succeed(quickly({"map", log("corridor_sf.rawlog"), "-o", path("out")}));
  EXPECT_GT(lines(contentOf(path("out/trajectory.tum"))), 90u);
}

TEST_F(CliTest, CheckReportsOnALog) {
  EXPECT_THAT(succeed({"check", log("loop.rawlog")}).out, HasSubstr("417 frames"));
}

TEST_F(CliTest, InfoListsTheSubmaps) {
  succeed(quickly({"build", log("room.rawlog"), "-o", path("s.rawlog")}));
  const std::string table = succeed({"info", path("s.rawlog")}).out;
  std::istringstream rows(table);
  std::string row, last;
  std::size_t count = 0;
  for (std::getline(rows, row); std::getline(rows, row); last = row) ++count;
  EXPECT_GT(count, 4u);
  EXPECT_THAT(last, StartsWith(std::to_string(count - 1) + " submaps, "));
}

TEST_F(CliTest, EvalOfTheTruthItselfFindsNoError) {
  writeFile(path("truth.tum"), "0 0 0 0 0 0 0 1\n10 1 0 0 0 0 0 1\n100 1 2 0 0 0 0 1\n");
  writeFile(path("r.relations"), "0 10 1 0 0 0 0 0\n0 100 1 2 0 0 0 0\n10 100 0 2.5 0 0 0 0\n");
  const auto result =
      nlohmann::json::parse(succeed({"eval", path("truth.tum"), "--reference", path("truth.tum"),
                                     "--relations", path("r.relations"), "--json"})
                                .out);
  EXPECT_LT(result["reference"]["absolute"]["translation_m"]["max"], 1e-9);
  EXPECT_EQ(result["relations"]["all"]["used"], 3);
  EXPECT_EQ(result["relations"]["local"]["used"], 1);
  EXPECT_EQ(result["relations"]["global"]["used"], 2);
  EXPECT_NEAR(result["relations"]["local"]["translation_m"]["mean"], 0, 1e-12);
  EXPECT_NEAR(result["relations"]["global"]["translation_m"]["mean"], 0.25, 1e-12);
}

TEST_F(CliTest, EvalHasNoFiguresWhereNothingWasEvaluated) {
  writeFile(path("t.tum"), "0 0 0 0 0 0 0 1\n10 1 0 0 0 0 0 1\n");
  writeFile(path("one.tum"), "10 1 0 0 0 0 0 1\n");
  writeFile(path("r.relations"), "0 10 1 0 0 0 0 0\n");
  const Arguments arguments{"eval",        path("t.tum"),  "--relations", path("r.relations"),
                            "--reference", path("one.tum")};
  Arguments json = arguments;
  json.push_back("--json");
  const auto result = nlohmann::json::parse(succeed(json).out);
  EXPECT_EQ(result["relations"]["local"]["translation_m"]["mean"], 0);
  EXPECT_EQ(result["relations"]["global"]["used"], 0);
  EXPECT_TRUE(result["relations"]["global"]["translation_m"].is_null());
  EXPECT_TRUE(result["relations"]["global"]["rotation_deg"].is_null());
  EXPECT_TRUE(result["reference"]["relative"]["translation_m"].is_null()) << "one pose has no step";

  const std::string table = succeed(arguments).out;
  EXPECT_THAT(table, ::testing::ContainsRegex("global > 60 s +0 +0 +- ± -"));
  EXPECT_THAT(table, ::testing::ContainsRegex("relative, position .m. +0 +- +-"));
}

TEST_F(CliTest, EvalTakesRelationsByTheirLength) {
  writeFile(path("t.tum"), "0 0 0 0 0 0 0 1\n10 1 0 0 0 0 0 1\n100 1 2 0 0 0 0 1\n");
  writeFile(path("r.relations"), "0 10 1 0 0 0 0 0\n0 100 1 2 0 0 0 0\n10 100 0 2.5 0 0 0 0\n");
  const auto used = [&](const char* option, const char* value) {
    const auto out =
        succeed({"eval", path("t.tum"), "--relations", path("r.relations"), "--json", option, value}).out;
    return nlohmann::json::parse(out)["relations"]["all"]["used"].get<int>();
  };
  EXPECT_EQ(used("--min-dt", "95"), 1);
  EXPECT_EQ(used("--max-dt", "95"), 2);
}

TEST_F(CliTest, SubmapsOfAnOlderVersionAreStillOpened) {
  const std::string old = SUBMAP_SLAM_SOURCE_DIR "/tests/rawlog/data/submaps_version_0.rawlog";
  const Outcome info = succeed({"info", old});
  EXPECT_EQ(lines(info.out), 3u + 2u) << info.out;  // submaps, heading, totals
  EXPECT_EQ(info.err, "");
}

}  // namespace
}  // namespace submap_slam::testing
