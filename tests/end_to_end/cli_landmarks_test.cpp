/** Landmark submaps through the program: from a text file or a rawlog to all results. */
#include <submap_slam/core/landmark_submap.h>
#include <submap_slam/rawlog/landmark_log.h>
#include <submap_slam/rawlog/submap_log.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli_fixture.h"

namespace submap_slam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Key;
using ::testing::Not;

constexpr int kSides = 8;

/** A drive round a regular octagon with sides of 10 m and a landmark at each corner; numbers without noise.
 * Each submap sees the landmarks at its start, its end and the corner behind. */
LandmarkSubmaps octagon() {
  LandmarkSubmaps submaps;
  const double turn = 2 * M_PI / kSides, side = 10;
  for (int k = 0; k < kSides; ++k) {
    auto submap = LandmarkSubmap::Create();
    submap->id = static_cast<uint32_t>(k);
    submap->end_pose = {side, 0, turn};
    for (int corner = 0; corner < 3; ++corner)
      submap->features.push_back({static_cast<uint32_t>(1 + (k + corner) % kSides),
                                  corner == 0 ? 0 : side + (corner - 1) * side * std::cos(turn),
                                  corner < 2 ? 0 : side * std::sin(turn), 2});
    submap->covariance.setIdentity(static_cast<int>(submap->dimension()));
    submap->covariance *= 1e-4;
    submaps.push_back(submap);
  }
  return submaps;
}

class CliLandmarks : public CliTest {
 protected:
  CliLandmarks() {
    writeLandmarkText(path("s.txt"), octagon());
    writeLandmarkText(path("s.txt.gz"), octagon());
    std::ofstream rawlog(path("s.rawlog"), std::ios::binary);
    for (const auto& submap : octagon()) {
      const auto bytes = gzipMember(*submap);
      rawlog.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
  }

  nlohmann::json metrics(const std::string& folder) const {
    return nlohmann::json::parse(contentOf(path(folder + "/metrics.json")));
  }
};

TEST_F(CliLandmarks, EditsOfGridSubmapsAreRefused) {
  writeFile(path("edits.txt"), "mask 0");
  expectRefused(run({"join", path("s.txt"), "-o", path("out"), "--edits", path("edits.txt")}),
                "--edits: is for grid submaps");
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(CliLandmarks, InfoDescribesThem) {
  for (const char* form : {"s.txt", "s.txt.gz", "s.rawlog"}) {
    const std::string list = succeed({"info", path(form)}).out;
    EXPECT_EQ(lines(list), 1u + 8u + 1u) << "heading, submaps, sums";
    EXPECT_THAT(list,
                HasSubstr("8 landmark submaps, - m, 0 poses, 24 features, dimension at most 9, ids of 8 "
                          "landmarks"));
    EXPECT_THAT(list, HasSubstr("0.014 m 0.57°"));
  }
}

TEST_F(CliLandmarks, InfoListsWhatIsGoodOfADamagedRawlog) {
  const std::string whole = contentOf(path("s.rawlog"));
  writeFile(path("cut.rawlog"), whole.substr(0, whole.size() - 20));
  const Outcome outcome = run({"info", path("cut.rawlog")});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.out, HasSubstr("7 landmark submaps"));
  EXPECT_THAT(outcome.err, HasSubstr("cut.rawlog: entry 7"));
}

TEST_F(CliLandmarks, InfoWritesThemAsText) {
  succeed({"info", path("s.rawlog"), "--text", path("copy.txt")});
  EXPECT_EQ(contentOf(path("copy.txt")), contentOf(path("s.txt")));
  expectRefused(run({"info", path("s.rawlog"), "--text", path("copy.txt")}), "--overwrite");
  succeed({"info", path("s.rawlog"), "--text", path("copy.txt"), "--overwrite"});
  expectRefused(run({"info", log("room.rawlog"), "--text", path("room.txt")}), "expected a file of landmark");
}

TEST_F(CliLandmarks, CommandsForLogsSayWhatTheyAreAndWhoTakesThem) {
  for (const char* form : {"s.txt", "s.txt.gz", "s.rawlog"}) {
    expectRefused(run({"check", path(form)}), "holds landmark submaps, for 'submap-slam info' and 'join'");
    expectRefused(run({"map", path(form), "-o", path("out")}), "holds landmark submaps");
  }
}

TEST_F(CliLandmarks, JoinWritesEveryResultAndSaysWhere) {
  const Outcome outcome = succeed({"join", path("s.txt"), "-o", path("out")});
  EXPECT_THAT(outcome.err, HasSubstr("map: " + path("out/map.png")));
  EXPECT_THAT(outcome.err, HasSubstr("8 submaps with 24 features, 8 landmarks"));
  EXPECT_THAT(outcome.err, HasSubstr("100 %"));
  const auto results = contentsOf(path("out"));
  for (const char* name : {"map.png", "map.3Dscene", "landmarks.csv", "association.csv", "trajectory.tum",
                           "metrics.json", "report.html", "config.ini", "log.txt"})
    EXPECT_THAT(results, ::testing::Contains(Key(name)));
  EXPECT_EQ(lines(results.at("landmarks.csv")), 1u + 8u);
  EXPECT_EQ(lines(results.at("association.csv")), 1u + 24u);
  EXPECT_EQ(lines(results.at("trajectory.tum")), 1u + 8u);
  EXPECT_EQ(results.at("map.png").substr(1, 3), "PNG");

  const auto m = metrics("out");
  EXPECT_NEAR(m["objective"].get<double>(), 0, 1e-6) << "the drive ends where it began";
  EXPECT_EQ(m["join_status"], "converged");
  EXPECT_EQ(m["landmarks"], 8);
  EXPECT_EQ(m["association"], "known");
  for (const char* key :
       {"wall_s", "cpu_s", "join_wall_s", "join_cpu_s", "peak_memory_mb", "version", "warnings"})
    EXPECT_TRUE(m.contains(key)) << key;
}

TEST_F(CliLandmarks, LandmarksAreWhereTheyAre) {
  succeed({"join", path("s.txt"), "-o", path("out"), "-q"});
  std::istringstream table(contentOf(path("out/landmarks.csv")));
  std::string row;
  std::getline(table, row);
  EXPECT_EQ(row, "id,x,y,sxx,sxy,syy,hits");
  for (int corner = 0; std::getline(table, row); ++corner) {
    int id = 0, hits = 0;
    double x = 0, y = 0, sxx = 0, sxy = 0, syy = 0;
    ASSERT_EQ(std::sscanf(row.c_str(), "%d,%lf,%lf,%lf,%lf,%lf,%d", &id, &x, &y, &sxx, &sxy, &syy, &hits), 7);
    const double turn = 2 * M_PI / kSides, radius = 5 / std::sin(turn / 2), angle = corner * turn - turn / 2;
    EXPECT_EQ(id, corner + 1);
    EXPECT_NEAR(x, 5 + radius * std::sin(angle), 1e-4);
    EXPECT_NEAR(y, radius * (std::cos(turn / 2) - std::cos(angle)), 1e-4);
    EXPECT_GT(sxx * syy, sxy * sxy);
    EXPECT_EQ(hits, 3) << "text has no hits; each corner is in three submaps";
  }
}

TEST_F(CliLandmarks, EveryFormOfTheFileGivesTheSameResults) {
  for (const char* form : {"s.txt", "s.txt.gz", "s.rawlog"})
    succeed({"join", path(form), "-o", path(std::string("out_") + form), "-q"});
  const auto text = contentsOf(path("out_s.txt"));
  for (const char* file : {"trajectory.tum", "association.csv", "map.png", "map.3Dscene", "config.ini"}) {
    EXPECT_EQ(text.at(file), contentsOf(path("out_s.txt.gz")).at(file)) << file;
    EXPECT_EQ(text.at(file), contentsOf(path("out_s.rawlog")).at(file)) << file;
  }
}

TEST_F(CliLandmarks, UnknownAssociationIsComparedWithTheIds) {
  succeed({"join", path("s.txt"), "-o", path("out"), "-q", "--unknown-association"});
  const auto m = metrics("out");
  EXPECT_EQ(m["association"], "unknown");
  EXPECT_EQ(m["landmarks"], 8);
  EXPECT_EQ(m["association_wrong"], 0);
  EXPECT_EQ(m["association_missed"], 0);
  EXPECT_EQ(m["features_dropped"], 0);
  EXPECT_THAT(contentOf(path("out/config.ini")), HasSubstr("association = jcbb"));
  succeed({"join", path("s.txt"), "-o", path("nn"), "-q", "--unknown-association", "--set",
           "eif_tree.association=nearest_neighbour"});
  EXPECT_THAT(contentOf(path("nn/config.ini")), HasSubstr("association = nearest_neighbour"));
}

TEST_F(CliLandmarks, NothingIsReplacedUnasked) {
  succeed({"join", path("s.txt"), "-o", path("out"), "-q"});
  expectRefused(run({"join", path("s.txt"), "-o", path("out"), "-q"}), path("out"));
  succeed({"join", path("s.txt"), "-o", path("out"), "-q", "--overwrite"});
}

TEST_F(CliLandmarks, BadInputIsRefusedInOneLine) {
  const std::string text = contentOf(path("s.txt"));
  writeFile(path("cut.txt"), text.substr(0, text.size() - 100));
  expectRefused(run({"join", path("cut.txt"), "-o", path("a")}), "cut.txt:");
  writeFile(path("nan.txt"), "MAP 1 3\n0 nan\n");
  expectRefused(run({"join", path("nan.txt"), "-o", path("b")}),
                "nan.txt:2: 'nan': expected a finite number");
  expectRefused(run({"join", path("s.txt"), "-o", path("c"), "--set", "joining.landmark_joiner=none"}),
                "no plugin offers the joiner 'none'; available: eif_tree");
  expectRefused(
      run({"join", path("s.txt"), "-o", path("d"), "--set", "joining.landmark_joiner=grid_gauss_newton"}),
      "no plugin offers the joiner 'grid_gauss_newton'");
}

TEST_F(CliLandmarks, UnknownAssociationOfGridsIsRefused) {
  expectRefused(run({"join", log("room.rawlog"), "-o", path("b"), "--unknown-association"}),
                "--unknown-association: expected a file of landmark submaps");
}

TEST_F(CliLandmarks, AJoinThatFailsSaysSoAndExitsWithAnError) {
  auto submap = octagon().front();
  submap->features.clear();
  submap->covariance.setIdentity(3);
  writeLandmarkText(path("many.txt"), LandmarkSubmaps(2700, submap));
  const Outcome outcome =
      run({"join", path("many.txt"), "-o", path("out"), "-q", "--set", "eif_tree.method=ekf"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("the submaps could not be joined: the state has 8100 elements"));
  EXPECT_EQ(metrics("out")["join_status"], "failed");
}

TEST_F(CliLandmarks, WhatIsBeforeADamageIsJoined) {
  const std::string whole = contentOf(path("s.rawlog"));
  writeFile(path("s.rawlog"), whole.substr(0, whole.size() - 20));
  const Outcome outcome = run({"join", path("s.rawlog"), "-o", path("out"), "-q"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("; the submaps before it are joined"));
  EXPECT_EQ(metrics("out")["submaps"], kSides - 1);
}

TEST_F(CliLandmarks, CovariancesThatAreNotFiniteAreRefused) {
  auto submap = octagon().front();
  submap->features.clear();
  submap->covariance.setIdentity(3);
  submap->covariance *= 1e308;
  writeLandmarkText(path("huge.txt"), LandmarkSubmaps(4, submap));
  const Outcome outcome = run({"join", path("huge.txt"), "-o", path("out"), "-q"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("not finite"));
}

TEST_F(CliLandmarks, JoinersOfBothFormsAreListed) {
  const std::string list = succeed({"--list-joiners"}).out;
  EXPECT_THAT(list, HasSubstr("eif_tree"));
  EXPECT_THAT(list, HasSubstr("grid_gauss_newton"));
}

}  // namespace
}  // namespace submap_slam::testing
