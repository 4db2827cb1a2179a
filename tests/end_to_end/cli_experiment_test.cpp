/** `experiment` fills its table whatever happens to single cells, and does nothing twice. */
#include <cmath>
#include <csignal>
#include <sstream>
#include <thread>

#include "cli_experiment_fixture.h"

namespace submap_slam::testing {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

TEST_F(ExperimentTest, HelpHasAnExample) {
  EXPECT_THAT(succeed({"experiment", "--help"}).out, HasSubstr("Example: submap-slam experiment "));
}

TEST_F(ExperimentTest, FillsTheTableAndRecordsHow) {
  succeed({"experiment", experiment("chain, odometry"), "-o", path("out"), "--jobs", "2"});
  EXPECT_THAT(table(), HasSubstr("# A test\n\n| data | setting | runs | MAE, m | AUC | submaps |\n"));
  EXPECT_THAT(table(), HasSubstr("\n| hall | chain | 2 | 0."));
  EXPECT_THAT(table(), HasSubstr("\n| hall | odometry | 2 | 0."));
  EXPECT_THAT(table(), HasSubstr("seeds 1, 2; submap-slam 0."));
  const std::string csv = contentOf(path("out/table.csv"));
  EXPECT_THAT(csv, HasSubstr("data,setting,runs,mae_m_mean,mae_m_std,auc_mean"));
  EXPECT_EQ(lines(csv), 3u);
  EXPECT_EQ(contentOf(path("out/experiment.ini")), contentOf(path("e.ini")));
  for (const char* setting : {"chain", "odometry"})
    EXPECT_THAT(contentOf(result(setting, "2").parent_path() / "config.ini"), HasSubstr("seed = 2\n"));
}

TEST_F(ExperimentTest, TruthScoresPerfectly) {
  const std::string file = experiment("truth", "[setting truth]\nbaseline = truth\n");
  succeed({"experiment", file, "-o", path("out"), "--set", "experiment.columns=mae_m, auc, accuracy"});
  EXPECT_THAT(table(), HasSubstr("| 0.0000 ± 0.0000 | 1.0000 ± 0.0000 | 1.0000 ± 0.0000 |"));
}

TEST_F(ExperimentTest, KeepsCompleteCells) {
  const Arguments arguments{"experiment", experiment("chain"), "-o", path("out")};
  succeed(arguments);
  const std::string before = table();
  const auto first = fs::last_write_time(result("chain", "1"));
  fs::remove(result("chain", "2"));
  EXPECT_THAT(succeed({"experiment", path("e.ini"), "-o", path("out"), "--list"}).out,
              HasSubstr("hall, chain, seed 1: complete\nhall, chain, seed 2: to do\n"));
  EXPECT_THAT(succeed(arguments).err, HasSubstr("[1/1] hall, chain, seed 2: done"));
  EXPECT_EQ(fs::last_write_time(result("chain", "1")), first);
  EXPECT_EQ(table(), before);
}

TEST_F(ExperimentTest, RunsCellsAnewWhoseSettingsChanged) {
  const std::string setting = "[setting other]\njoining.chain =\nsubmaps.max_distance = ";
  succeed({"experiment", experiment("chain, other", setting + "3\n"), "-o", path("out"), "-q"});
  const Outcome changed =
      succeed({"experiment", experiment("chain, other", setting + "2\n"), "-o", path("out")});
  EXPECT_THAT(changed.err, HasSubstr("[2/2] hall, other, seed 2: done"));
  EXPECT_THAT(changed.err, Not(HasSubstr("hall, chain")));
}

TEST_F(ExperimentTest, GoesOnAfterAKill) {
  const Arguments arguments{"experiment", experiment("chain, odometry"), "-o", path("out")};
  Process process = start(arguments);
  while (process.running() && !fs::exists(result("chain", "1"))) std::this_thread::yield();
  process.signal(SIGKILL);
  ASSERT_EQ(process.wait().exit_code, -SIGKILL);
  const auto first = fs::last_write_time(result("chain", "1"));
  succeed(arguments);
  EXPECT_EQ(fs::last_write_time(result("chain", "1")), first);
  for (const char* setting : {"chain", "odometry"})
    for (const char* seed : {"1", "2"}) EXPECT_TRUE(fs::exists(result(setting, seed)));
  EXPECT_THAT(table(), Not(HasSubstr("not run")));
}

TEST_F(ExperimentTest, StopsOnASignalAndGoesOn) {
  const Arguments arguments{"experiment", experiment("chain, odometry"), "-o", path("out")};
  Process process = start(arguments);
  while (process.running() && !fs::exists(result("chain", "1"))) std::this_thread::yield();
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait().exit_code, 130);
  EXPECT_THAT(table(), HasSubstr("not run"));
  succeed(arguments);
  EXPECT_THAT(table(), Not(HasSubstr("not run")));
}

TEST_F(ExperimentTest, FailedCellsShowTheirErrorAndTheRestCompletes) {
  const std::string file = experiment("chain, deaf", "[setting deaf]\nreader.sensor_labels = SONAR\n");
  const Outcome outcome = run({"experiment", file, "-o", path("out"), "-q"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(lines(outcome.err), 1u) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("2 cells failed"));
  EXPECT_THAT(table(), HasSubstr("\n| hall | chain | 2 | 0."));
  EXPECT_THAT(table(), HasSubstr("\n| hall | deaf | 0 | – | – | – | failed: seed 1: "));
  EXPECT_THAT(table(), HasSubstr("SONAR"));
  EXPECT_THAT(contentOf(path("out/table.csv")), HasSubstr("hall,deaf,0,,,,,,,\"seed 1: "));
}

TEST_F(ExperimentTest, PageHasTablePlotsAndWhatFailed) {
  const std::string plots = "[plot errors]\ny = mae_m\nx = seed\n[plot maps]\ny = auc\nx = data\n";
  const std::string file =
      experiment("odometry, deaf", "[setting deaf]\nreader.sensor_labels = SONAR\n" + plots);
  run({"experiment", file, "-o", path("out"), "-q"});
  const Json page = pageData();
  EXPECT_EQ(page["kind"], "experiment");
  EXPECT_EQ(page["title"], "A test");
  EXPECT_EQ(page["seeds"], Json({"1", "2"}));
  EXPECT_EQ(page["description"], contentOf(path("out/experiment.ini")));

  ASSERT_EQ(page["cells"].size(), 4u);
  const Json &heard = page["cells"][1], &deaf = page["cells"][2];
  EXPECT_EQ(heard["seed"], "2");
  EXPECT_EQ(heard["error"], "");
  EXPECT_THAT(heard["build"].get<std::string>(), ::testing::SizeIs(16));
  EXPECT_THAT(heard["mrpt"].get<std::string>(), HasSubstr("MRPT"));
  EXPECT_THAT(deaf["error"].get<std::string>(), HasSubstr("SONAR"));
  EXPECT_EQ(deaf["values"], Json({nullptr, nullptr, nullptr}));

  const double first = page["cells"][0]["values"][0], second = heard["values"][0];
  EXPECT_NEAR(page["rows"][0]["values"][0]["mean"], (first + second) / 2, 1e-12);
  EXPECT_TRUE(page["rows"][1]["values"][0].is_null());

  ASSERT_EQ(page["plots"].size(), 2u);
  const Json &errors = page["plots"][0], &maps = page["plots"][1];
  EXPECT_EQ(errors["places"], Json({"1", "2"}));
  EXPECT_EQ(errors["series"][0]["label"], "hall, odometry");
  EXPECT_EQ(errors["series"][0]["points"][1]["mean"], second);
  EXPECT_TRUE(errors["series"][1]["points"][1].is_null());
  EXPECT_EQ(maps["places"], Json({"hall"}));
  EXPECT_EQ(maps["series"][1]["label"], "deaf");
  EXPECT_EQ(maps["series"][0]["points"][0], page["rows"][0]["values"][1]);
}

TEST_F(ExperimentTest, PlotsSeveralColumnsBesideEachOther) {
  succeed({"experiment", experiment("chain", "[plot times]\ny = wall_s, join_wall_s\n"), "-o", path("out"),
           "-q"});
  const Json plot = pageData()["plots"][0];
  EXPECT_EQ(plot["y"]["label"], "s");
  ASSERT_EQ(plot["series"].size(), 2u);
  EXPECT_EQ(plot["series"][0]["label"], "hall, total, s");
  EXPECT_EQ(plot["series"][1]["label"], "hall, joining, s");
  EXPECT_GT(plot["series"][0]["points"][0]["mean"], plot["series"][1]["points"][0]["mean"]);
}

TEST_F(ExperimentTest, PlotsEachColumnOverTheSettingsUnlessToldOtherwise) {
  succeed({"experiment", experiment("chain, odometry"), "-o", path("out"), "-q"});
  const Json plots = pageData()["plots"];
  ASSERT_EQ(plots.size(), 3u);
  EXPECT_EQ(plots[1]["title"], "AUC");
  EXPECT_EQ(plots[1]["kind"], "bars");
  EXPECT_EQ(plots[1]["places"], Json({"chain", "odometry"}));
  EXPECT_EQ(plots[1]["series"].size(), 1u);
  EXPECT_EQ(plots[1]["series"][0]["points"].size(), 2u);
}

TEST_F(ExperimentTest, VariesSettingsAnewForEachSeed) {
  const std::string varied =
      "[setting varied]\njoining.chain =\nsubmaps.max_distance = 4\nvary = 0.5\n"
      "varied = submaps.max_distance, particles.max, rescue.below\n";
  succeed({"experiment", experiment("varied", varied), "-o", path("out"), "--set", "experiment.worst=true"});
  const auto valueOf = [&](const std::string& key, const char* seed) {
    const std::string ini = contentOf(result("varied", seed).parent_path() / "config.ini");
    return std::stod(ini.substr(ini.find("\n" + key + " = ") + key.size() + 4));
  };
  EXPECT_NE(valueOf("max_distance", "1"), valueOf("max_distance", "2"));
  for (const char* seed : {"1", "2"}) {
    EXPECT_GE(valueOf("max_distance", seed), 2);
    EXPECT_LE(valueOf("max_distance", seed), 6);
    EXPECT_EQ(valueOf("max", seed), std::round(valueOf("max", seed)));
    EXPECT_LE(valueOf("below", seed), 1) << "beyond what is allowed";
  }
  EXPECT_THAT(table(), HasSubstr(", ≤ "));
  EXPECT_THAT(contentOf(path("out/table.csv")), HasSubstr("mae_m_mean,mae_m_std,mae_m_max,"));
}

TEST_F(ExperimentTest, JudgesRecordingsByTruthAndRelations) {
  std::ostringstream relations;
  const double start = 1577836800;  // of the simulated logs
  relations << std::fixed << start << ' ' << start + 1 << " 0.8 0 0 0 0 0\n";
  writeFile(path("corridor.relations"), relations.str());
  writeFile(path("e.ini"),
            "[experiment]\ndata = corridor\nsettings = chain\ncolumns = mae_m, relations_m, scans\n"
            "[data corridor]\nlog = corridor.rawlog\ntruth = corridor.tum\nrelations = corridor.relations\n"
            "[setting chain]\njoining.chain =\n");
  fs::copy_file(log("corridor_sf.rawlog"), path("corridor.rawlog"));
  fs::copy_file(log("corridor_sf.truth.tum"), path("corridor.tum"));
  succeed({"experiment", path("e.ini"), "-o", path("out")});
  EXPECT_THAT(table(), HasSubstr("\n| corridor | chain | 1 | 0."));
  EXPECT_THAT(table(), HasSubstr("| 401 |"));
  EXPECT_THAT(table(), Not(HasSubstr("–")));
}

TEST_F(ExperimentTest, RefusesBadDescriptions) {
  const auto refuses = [&](const std::string& ini, const std::string& text) {
    writeFile(path("bad.ini"), ini);
    expectRefused(run({"experiment", path("bad.ini"), "-o", path("out")}), text);
  };
  const std::string head = "[experiment]\ndata = hall\nsettings = chain\ncolumns = auc\n";
  expectRefused(run({"experiment", path("missing.ini")}), "missing.ini: no such ini file");
  refuses("", "[experiment] data: is empty");
  refuses("[experiment]\ndatta = hall\n", "did you mean [experiment] data?");
  refuses("[experimant]\n", "unknown section [experimant]");
  refuses(head + kData, "no section [setting chain]");
  refuses(head + kChain, "no section [data hall]");
  refuses(head + kData + "[setting chain]\nsubmaps.max_distence = 3\n",
          "did you mean [submaps] max_distance?");
  refuses(head + kData + "[setting chain]\njoining.chain = magic\n", "magic");
  refuses(head + kData + "[setting chain]\nbaseline = magic\n", "expected odometry or truth");
  refuses(head + kData + kChain + "varied = submaps.max_distence\n", "no such parameter to vary");
  refuses(head + kData + kChain + "varied = mapper.method\n", "only numbers can be varied");
  refuses(head + kData + kChain + "vary = 2\n", "must lie in [0, 1]");
  refuses(head + kChain + "[data hall]\nworld = moon\n", "expected one of room");
  refuses(head + kChain + "[data hall]\nwerld = room\n", "unknown key [data hall] werld");
  refuses(head + kChain + "[data hall]\nworld = room\nsimulation.beam = 3\n",
          "did you mean [simulation] beams?");
  refuses(head + kChain + "[data hall]\ntruth = missing.tum\n", "missing.tum: no such file");
  refuses(head + kChain + "[data hall]\n", "needs either a world or a log");
  refuses(head + kChain + "[data hall]\nlog = " + log("room.rawlog") + "\nlandmarks = bad.ini\n",
          "[data hall]: landmarks needs truth");
  refuses(head + "seeds = one\n" + kData + kChain, "'one' is not a whole number");
  refuses(head + "seeds = 1, -1\n" + kData + kChain, "'-1' is not a whole number, 0 or more");
  refuses("[experiment]\ndata = hall\nsettings = chain\ncolumns = beauty\n" + std::string(kData) + kChain,
          "unknown column 'beauty'");
  const std::string plot = head + kData + kChain + "[plot errors]\n";
  refuses(plot, "[plot errors]: needs y");
  refuses(plot + "y = beauty\n", "[plot errors] y: unknown column 'beauty'");
  refuses(plot + "y = auc\nx = day\n", "[plot errors] x = 'day': expected setting or data or seed or time");
  refuses(plot + "y = auc\nkind = pie\n",
          "[plot errors] kind = 'pie': expected bars or lines or errors or path");
  refuses(plot + "y = auc, cpu_s\n", "[plot errors] y: auc and cpu_s have different units");
  refuses(plot + "y = auc\nx = time\n", "[plot errors]: x = time needs kind = lines");
  refuses(plot + "y = auc\nx = time\nkind = lines\n", "x = time needs y = ci_frames or y = nees_frames");
  refuses(plot + "kind = errors\ny = auc\n", "kind = errors and kind = path have neither x nor y");
  refuses(plot + "y = auc\nseed = 1\n", "seed is for kind = errors and kind = path");
  refuses(plot + "kind = path\nseed = 7\n", "[plot errors] seed = 7: is none of [experiment] seeds");
  refuses(plot + "y = auc\ncolour = red\n", "unknown key [plot errors] colour");
  EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(ExperimentTest, NamesTheLineThatIsWrong) {
  const std::string file = path("bad.ini");
  const auto refuses = [&](const std::string& line, const std::string& text) {
    writeFile(file, "[experiment]\ndata = hall\nsettings = chain\ncolumns = auc\n" + std::string(kData) +
                        "[setting chain]\n" + line + "\njoining.chain =\n");
    expectRefused(run({"experiment", file, "-o", path("out")}), file + ":" + text);
  };
  refuses("submaps.max_distance 3", "10: 'submaps.max_distance 3': expected key = value");
  refuses("[setting", "10: '[setting': expected [section]");
  refuses("joining.chain = grid_gauss_newton",
          "11: [setting chain] joining.chain was set in line 10 already");
  refuses("submaps.max_distance = far", "10: [submaps] max_distance = 'far': expected a number");
  refuses("max_distance = 3", "10: 'max_distance=3': expected section.key=value");
  refuses(
      "grid_gauss_newton.levels = 10\ngrid_gauss_newton.finest_level = 6\n"
      "joining.chain = grid_gauss_newton\n[data unused]",
      "9: [grid_gauss_newton] levels + finest_level");
  refuses("[settings none]", "10: unknown section [settings none]");
  refuses("[data hall]\nbeams = 3", "11: unknown key [data hall] beams");
  refuses("[data hall]\nlog = bad.ini\n[data unused]", "5: [data hall]: needs either a world or a log");
  refuses("[data hall]\nsimulation.max_scans = 5", "11: [data hall] simulation.max_scans was set in line 8");
  refuses("[data hall]\nsimulation.scan_rate = -1\n[data unused]",
          "11: [simulation] scan_rate = -1: must lie in");
  refuses("[experiment]\nsedes = 1", "11: unknown key [experiment] sedes; did you mean [experiment] seeds?");
  EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(ExperimentTest, RecordsOverridesAndRunsFromTheRecord) {
  const Arguments overrides{"--set", "experiment.seeds=7"};
  Arguments arguments{"experiment", experiment("odometry"), "-o", path("out")};
  arguments.insert(arguments.end(), overrides.begin(), overrides.end());
  succeed(arguments);
  EXPECT_TRUE(fs::exists(result("odometry", "7")));
  EXPECT_THAT(contentOf(path("out/experiment.ini")), HasSubstr("\nseeds = 7\n"));
  const std::string before = table();
  const Outcome again = succeed({"experiment", path("out/experiment.ini"), "-o", path("out"), "--list"});
  EXPECT_EQ(again.out, "hall, odometry, seed 7: complete\n");
  succeed({"experiment", path("out/experiment.ini"), "-o", path("fresh"), "-q"});
  EXPECT_EQ(contentOf(path("fresh/table.md")), before);
}

TEST_F(ExperimentTest, RunsCellsOfAnotherBuildAnewUnlessToldToKeepThem) {
  const Arguments list{"experiment", experiment("odometry"), "-o", path("out"), "--list"};
  succeed({"experiment", path("e.ini"), "-o", path("out"), "-q"});
  std::string text = contentOf(result("odometry", "1"));
  const std::string key = "\"build\": \"";
  ASSERT_NE(text.find(key), std::string::npos);
  EXPECT_THAT(text, HasSubstr("\"mrpt\": \"MRPT"));
  text.replace(text.find(key) + key.size(), 16, "0123456789abcdef");
  writeFile(result("odometry", "1"), text);
  EXPECT_THAT(succeed(list).out, HasSubstr("seed 1: to do\nhall, odometry, seed 2: complete\n"));
  Arguments keep = list;
  keep.emplace_back("--any-build");
  EXPECT_THAT(succeed(keep).out, HasSubstr("seed 1: complete\n"));
  keep.erase(keep.end() - 2);  // --list
  succeed(keep);
  EXPECT_THAT(table(), HasSubstr("0123456789abcdef"));
}

TEST_F(ExperimentTest, NeverWritesIntoAFolderOfSomethingElse) {
  fs::create_directory(path("out"));
  writeFile(path("out/mine.txt"), "mine");
  expectRefused(run({"experiment", experiment("chain"), "-o", path("out")}), "out");
  EXPECT_EQ(contentsOf(path("out")).size(), 1u);
}

TEST_F(ExperimentTest, BundledExperimentsAreValid) {
  for (const char* name : {"intel", "aces", "mit-csail", "fr-clinic"}) {  // stand for recordings
    fs::create_directory(path(name));
    for (const char* end : {".rawlog", ".relations"})
      writeFile(path(std::string(name) + "/" + name + end), "");
  }
  for (const char* name : {"victoria_park_observations.rawlog", "reference_path.tum", "gps.txt"})
    writeFile(path(name), "");
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(SUBMAP_SLAM_SOURCE_DIR "/ini/experiments")) {
    if (!entry.is_regular_file()) continue;
    ++files;
    EXPECT_THAT(
        succeed({"experiment", entry.path().string(), "-o", path("out"), "--data", path(""), "--list"}).out,
        HasSubstr("to do"));
  }
  EXPECT_GE(files, 7u);
}

}  // namespace
}  // namespace submap_slam::testing
