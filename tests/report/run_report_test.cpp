#include <gmock/gmock.h>
#include <submap_slam/report/run_report.h>

#include <cmath>
#include <stdexcept>

#include "../output/sample_results.h"

namespace submap_slam {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::ElementsAre;

GridSubmap::Ptr submapAt(uint32_t id, double start_s) {
  auto submap = GridSubmap::Create();
  submap->id = id;
  submap->evidence = sampleGrid().unpacked();
  for (int n = 0; n < 3; ++n)
    submap->nodes.push_back({mrpt::Clock::fromDouble(start_s + n), {n * 1.0, 0, 0}, {}, {}});
  return submap;
}

Constraint loop(uint32_t from, uint32_t to, const CPosePDFGaussian& T_a_b, bool accepted) {
  Constraint c;
  c.from = from, c.to = to, c.T_a_b = T_a_b, c.inter = true, c.accepted = accepted, c.reason = "why";
  return c;
}

class RunReport : public ::testing::Test {
 protected:
  RunReport() {
    joined.map = sampleGrid();
    joined.frames = {gaussian(0, 0, 0), gaussian(2, 0, M_PI / 2)};
    joined.frames[0].cov.setZero();
    joined.iterations = {{1, 5.0, 0.1, 0.01}};
  }

  Json report() const { return runReport(submaps, joined, mappingProgress(submaps, joined.frames), record); }

  GridSubmaps submaps{submapAt(4, 1000), submapAt(5, 1003)};
  JoinedMap joined;
  RunRecord record{"some.rawlog", "[run]\nseed = 1\n", {"a message"}, {{"wall_s", 1.5}}};
};

TEST_F(RunReport, HasAllThatIsShown) {
  const Json data = report();
  EXPECT_EQ(data["kind"], "run");
  EXPECT_EQ(data["form"], "grid");
  EXPECT_EQ(data["submaps"].size(), 2u);
  EXPECT_EQ(data["submaps"][1]["id"], 5);
  EXPECT_EQ(data["iterations"][0]["cost"], 5.0);
  EXPECT_EQ(data["input"], "some.rawlog");
  EXPECT_EQ(data["messages"][0], "a message");
  EXPECT_EQ(data.back(), record.metrics) << "times come last";
  EXPECT_EQ(data["map"]["y_max"], 3.5);
}

TEST_F(RunReport, TrajectoryIsInTheGlobalFrameAndKnowsItsUncertainty) {
  const Json path = report()["trajectory"];
  EXPECT_EQ(path["start"], 1000);
  EXPECT_THAT(path["t"].get<std::vector<double>>(), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(path["x"].get<std::vector<double>>(), ElementsAre(0, 1, 2, 2, 2, 2));
  EXPECT_THAT(path["y"].get<std::vector<double>>(), ElementsAre(0, 0, 0, 0, 1, 2));
  EXPECT_THAT(path["submap"].get<std::vector<int>>(), ElementsAre(0, 0, 0, 1, 1, 1));
  // The frame's covariance is diag(0.04, 0.01, 0.0025); a lever of n m along y adds 0.0025 n² to x.
  EXPECT_THAT(path["sigma"].get<std::vector<double>>(),
              ElementsAre(0, 0, 0, 0.2, std::round(1e4 * std::sqrt(0.0425)) / 1e4,
                          std::round(1e4 * std::sqrt(0.05)) / 1e4));
}

TEST_F(RunReport, ConstraintsSayWhatIsLeft) {
  // Frame 5 seen from frame 4 is (2, 0, 90°); the constraint says (2, −0.3, 89°).
  const double deg = M_PI / 180;
  joined.constraints = {loop(4, 5, gaussian(2, -0.3, 89 * deg), true), loop(4, 9, gaussian(0, 0, 0), false)};
  const Json constraints = report()["constraints"];
  ASSERT_EQ(constraints.size(), 1u) << "submap 9 is not there";
  EXPECT_EQ(constraints[0]["from"], 0) << "positions in the list, not ids";
  EXPECT_EQ(constraints[0]["to"], 1);
  EXPECT_EQ(constraints[0]["left_m"], 0.3);
  EXPECT_NEAR(constraints[0]["left_deg"].get<double>(), 1, 1e-3);
  // 0.3 along y of frame 4, where σ = 0.1; 1° where σ = 0.05 rad.
  EXPECT_NEAR(constraints[0]["left_sigma"].get<double>(), std::hypot(3, deg / 0.05), 0.006);
}

TEST_F(RunReport, ConstraintThatIsCertainHasNoSigmas) {
  CPosePDFGaussian certain = gaussian(2, 0, M_PI / 2);
  certain.cov.setZero();
  joined.constraints = {loop(4, 5, certain, true)};
  EXPECT_FALSE(std::isfinite(report()["constraints"][0]["left_sigma"].get<double>()));
}

TEST_F(RunReport, MustHaveAFrameForEachSubmap) {
  const auto progress = mappingProgress(submaps, joined.frames);
  joined.frames.pop_back();
  EXPECT_THROW(runReport(submaps, joined, progress, record), std::invalid_argument);
}

TEST(LandmarkReport, ShowsLandmarksAndEndPoses) {
  auto submap = LandmarkSubmap::Create();
  submap->id = 3;
  submap->features = {{7, 1, 1, 2}};
  JoinedLandmarks joined;
  joined.frames = {gaussian(0, 0, 0), gaussian(2, 1, 0)};
  JoinedLandmark landmark;
  landmark.id = 7, landmark.x = 1, landmark.y = 1, landmark.hits = 2;
  landmark.covariance.setDiagonal(std::vector<double>{0.04, 0.01});
  joined.landmarks = {landmark};
  joined.associations = {{3, 7, FeatureAssociation::Kind::kKnown, 7, 0}};
  const Json data = runReport({submap}, joined, {"s.txt", "", {}, Json::object()});
  EXPECT_EQ(data["form"], "landmarks");
  EXPECT_EQ(data["landmarks"][0]["sigma_major"], 0.2);
  EXPECT_EQ(data["trajectory"]["x"], Json({2.0}));
  EXPECT_EQ(data["trajectory"]["sigma"], Json({0.2}));
  EXPECT_EQ(data["submaps"][0]["features"], 1);
  EXPECT_EQ(data["associations"]["known"], 1);
  joined.frames.pop_back();
  EXPECT_THROW(runReport({submap}, joined, {}), std::invalid_argument);
}

}  // namespace
}  // namespace submap_slam
