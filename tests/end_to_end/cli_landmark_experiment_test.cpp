/** What `experiment` and `eval` say of landmarks with known truth. */
#include <numeric>

#include "cli_experiment_fixture.h"

namespace submap_slam::testing {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

/** A drive with landmarks and known truth, with and without the ids of the log. */
class LandmarkExperimentTest : public ExperimentTest {
 protected:
  static constexpr const char* kDrive =
      "[data drive]\nlog = landmarks.rawlog\ntruth = landmarks.truth.tum\n"
      "landmarks = landmarks.landmarks.csv\nvehicle.model = ackermann\nvehicle.wheel_base = 4\n"
      "vehicle.encoder_offset = 0\nvehicle.sigma_velocity = 0.1\nvehicle.sigma_steering = 0.01745\n"
      "vehicle.stabilising_xy = 0\nvehicle.stabilising_turn = 0\n";
  static constexpr const char* kSettings =
      "[setting ids]\nlandmark_mapper.method = ekf\n"
      "[setting no_ids]\nlandmark_mapper.method = ekf\nlandmark_mapper.known_ids = false\n";

  void runExperiment(const std::string& settings, const std::string& plots) const {
    writeFile(path("e.ini"), "[experiment]\ndata = drive\nsettings = " + settings +
                                 "\nseeds = 1, 2\ncolumns = landmark_rmse_m, landmarks, landmarks_compared, "
                                 "ci_frames, nees_local\n" +
                                 kDrive + kSettings + plots);
    succeed({"experiment", path("e.ini"), "-o", path("out"), "--data", log(""), "-q"});
  }

  Json figures(const std::string& setting) const {
    return Json::parse(contentOf(folder_ / "out" / "cells" / "drive" / setting / "1" / "result.json"));
  }
};

TEST_F(LandmarkExperimentTest, LandmarksWithoutIdsAreJudgedByTheirPlaces) {
  runExperiment("ids, no_ids", "");
  for (const char* setting : {"ids", "no_ids"}) {
    const Json cell = figures(setting);
    EXPECT_LT(cell["landmark_rmse_m"], 1.5) << setting;
    EXPECT_GT(cell["landmarks_compared"], 0.8 * cell["landmarks"].get<double>()) << setting;
    EXPECT_LE(cell["landmarks_compared"], 60) << setting;
  }
}

TEST_F(LandmarkExperimentTest, PlotsCurvesErrorsAndPaths) {
  runExperiment(
      "ids",
      "[plot over_time]\nx = time\ny = ci_frames\nkind = lines\n[plot bounds]\nkind = errors\nseed = 2\n"
      "[plot map]\nkind = path\n");
  const Json plots = pageData()["plots"], row = pageData()["rows"][0];
  ASSERT_EQ(plots.size(), 3u);
  const Json& curve = plots[0]["curves"][0];
  EXPECT_EQ(plots[0]["expected"]["value"], 1) << "of a consistency index";
  EXPECT_EQ(curve["label"], "drive, ids");
  const auto values = curve["values"].get<std::vector<double>>();
  ASSERT_GT(values.size(), 2u);
  EXPECT_EQ(curve["t"].size(), values.size());
  EXPECT_GT(curve["t"][0], 1) << "the first submap does not end where it starts";
  EXPECT_LT(curve["t"].back(), 1000) << "seconds since the start";
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  EXPECT_NEAR(row["values"][3]["mean"], mean, 1e-4 * mean);

  EXPECT_EQ(plots[1]["seed"], "2");
  const Json& bounds = plots[1]["curves"][0];
  const std::string csv = contentOf(folder_ / "out/cells/drive/ids/2/consistency.csv");
  EXPECT_EQ(bounds["x"]["error"].size() + 1, lines(csv));
  EXPECT_GT(bounds["phi"]["sigma"][0], 0);

  const Json& map = plots[2]["curves"][0];
  EXPECT_EQ(plots[2]["seed"], "1");
  EXPECT_EQ(map["fixes"]["x"].size(), 0u);
  EXPECT_EQ(map["truth"]["x"].size(), lines(contentOf(log("landmarks.truth.tum"))));
  EXPECT_EQ(map["paths"][0]["label"], "ids");
  EXPECT_NEAR(map["paths"][0]["x"][0], map["truth"]["x"][0], 3) << "the path lies on the truth";
}

TEST_F(LandmarkExperimentTest, JoinsLogsOfLandmarkSubmaps) {
  runExperiment("ids", "");
  const std::string submaps = "out/cells/drive/ids/1/landmark_submaps.rawlog";
  writeFile(
      path("joined.ini"),
      "[experiment]\ndata = submaps\nsettings = tree\ncolumns = landmark_rmse_m, ci_frames, nees_local\n"
      "[data submaps]\nlog = " +
          path(submaps) +
          "\ntruth = landmarks.truth.tum\n"
          "landmarks = landmarks.landmarks.csv\n[setting tree]\neif_tree.method = tree_gn\n");
  succeed({"experiment", path("joined.ini"), "-o", path("again"), "--data", log(""), "-q"});
  const Json mapped = figures("ids");
  const Json joined = Json::parse(contentOf(path("again/cells/submaps/tree/1/result.json")));
  for (const char* key : {"landmark_rmse_m", "ci_frames", "nees_local"})
    EXPECT_EQ(joined[key], mapped[key]) << key;
}

TEST_F(LandmarkExperimentTest, EvalPrintsTheSameOfAFolderAndWritesNothing) {
  runExperiment("no_ids", "");
  const std::string folder = path("out/cells/drive/no_ids/1");
  const auto before = contentsOf(folder);
  const Arguments arguments{"eval",        folder,
                            "--reference", log("landmarks.truth.tum"),
                            "--landmarks", log("landmarks.landmarks.csv")};
  EXPECT_THAT(succeed(arguments).out, HasSubstr("landmarks by place"));
  Arguments as_json = arguments;
  as_json.emplace_back("--json");
  const Json judged = Json::parse(succeed(as_json).out)["landmarks"], cell = figures("no_ids");
  for (const char* key : {"landmark_rmse_m", "ci_landmarks", "ci_frames", "nees_local"})
    EXPECT_EQ(judged[key], cell[key]) << key;
  EXPECT_EQ(contentsOf(folder), before);
  for (const char* stale : {"/landmark_frames.csv", "/landmark_trajectory.tum"})
    writeFile(folder + stale, "of an earlier run beside grids");
  EXPECT_EQ(Json::parse(succeed(as_json).out)["landmarks"], judged);
  const std::string truth = log("landmarks.landmarks.csv"), tum = folder + "/trajectory.tum";
  expectRefused(run({"eval", tum, "--landmarks", truth, "--reference", tum}),
                "expected the folder of a result");
  expectRefused(run({"eval", folder, "--landmarks", truth, "--relations", tum}),
                "--landmarks needs --reference");
}

}  // namespace
}  // namespace submap_slam::testing
