#include <gmock/gmock.h>
#include <submap_slam/report/comparison.h>

#include <cmath>

#include "../output/sample_results.h"

namespace submap_slam {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::HasSubstr;

RunFolder runWith(const Trajectory& trajectory, const Json& metrics) {
  RunFolder run;
  run.metrics = metrics;
  run.settings = {{"run", "", "", 1}, {"run", "seed", "1", 2}};
  run.trajectory = TimedTrajectory(trajectory);
  return run;
}

const ComparisonRow& rowOf(const ComparisonTable& table, const std::string& name) {
  for (const auto& row : table.rows)
    if (row.name == name) return row;
  throw std::out_of_range(name);
}

/** The poses of the sample as a map frame at `T_w2_w` sees them. */
Trajectory seenFrom(const mrpt::math::TPose2D& T_w2_w, std::size_t leave_out = 0) {
  Trajectory trajectory = sampleTrajectory();
  trajectory.erase(trajectory.begin(), trajectory.begin() + static_cast<std::ptrdiff_t>(leave_out));
  for (auto& p : trajectory) p.pose = T_w2_w + p.pose;
  return trajectory;
}

TEST(Comparison, ARunThatBeginsLaterIsLaidOnTheFirstOne) {
  const mrpt::math::TPose2D T_w2_w(3, -1, 0.7);
  const Comparison c =
      compareRuns({runWith(sampleTrajectory(), Json::object()), runWith(seenFrom(T_w2_w, 1), Json::object())},
                  {"a", "b"});
  const auto expected = mrpt::math::TPose2D() - T_w2_w;
  EXPECT_NEAR(c.seen[1].T_ref_w.x, expected.x, 1e-9);
  EXPECT_NEAR(c.seen[1].T_ref_w.y, expected.y, 1e-9);
  EXPECT_NEAR(c.seen[1].T_ref_w.phi, expected.phi, 1e-9);
  const auto& table = c.tables[2];
  EXPECT_EQ(rowOf(table, "poses").values, (std::vector<Json>{3, 2}));
  EXPECT_EQ(rowOf(table, "common_poses").values, (std::vector<Json>{nullptr, 2}));
  EXPECT_NEAR(rowOf(table, "apart_max_m").values[1].get<double>(), 0, 1e-9);
}

TEST(Comparison, DifferencesAreThoseByHand) {
  Trajectory moved = sampleTrajectory();
  moved[1].pose.x += 0.3, moved[1].pose.y += 0.4;
  moved[2].pose.phi += 0.1;
  const Comparison c =
      compareRuns({runWith(sampleTrajectory(), Json::object()), runWith(moved, Json::object())}, {"a", "b"});
  EXPECT_NEAR(rowOf(c.tables[2], "apart_max_m").values[1].get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(rowOf(c.tables[2], "apart_mean_m").values[1].get<double>(), 0.5 / 3, 1e-9);
  EXPECT_NEAR(rowOf(c.tables[2], "turned_max_deg").values[1].get<double>(), 0.1 * 180 / M_PI, 1e-9);
}

TEST(Comparison, RunsOfOtherTimesKeepTheirFrames) {
  Trajectory later = sampleTrajectory();
  for (auto& p : later) p.stamp += std::chrono::hours(1);
  const Comparison c =
      compareRuns({runWith(sampleTrajectory(), Json::object()), runWith(later, Json::object())}, {"a", "b"});
  EXPECT_EQ(c.seen[1].T_ref_w, mrpt::math::TPose2D());
  EXPECT_EQ(rowOf(c.tables[2], "common_poses").values[1], 0);
  EXPECT_THROW(rowOf(c.tables[2], "apart_mean_m"), std::out_of_range);
}

TEST(Comparison, TablesHoldWhatAnyRunHas) {
  RunFolder a = runWith(sampleTrajectory(), {{"submaps", 2},
                                             {"cpu_s", 1.5},
                                             {"warnings", {"w"}},
                                             {"stages", {{{"name", "build"}, {"cpu_s", 1.0}}}}});
  RunFolder b = runWith(sampleTrajectory(), {{"submaps", 2}, {"landmarks", 5}});
  b.settings[1].value = "7";
  b.settings.push_back({"own", "key", "", 4});
  const Comparison c = compareRuns({a, b}, {"a", "b"});
  EXPECT_EQ(rowOf(c.tables[0], "warnings").values, (std::vector<Json>{1, nullptr}));
  EXPECT_EQ(rowOf(c.tables[0], "landmarks").values, (std::vector<Json>{nullptr, 5}));
  EXPECT_THROW(rowOf(c.tables[0], "cpu_s"), std::out_of_range) << "is in the next table";
  EXPECT_EQ(rowOf(c.tables[1], "cpu_s").values, (std::vector<Json>{1.5, nullptr}));
  EXPECT_EQ(rowOf(c.tables[1], "build_cpu_s").values, (std::vector<Json>{1.0, nullptr}));
  ASSERT_EQ(c.tables[3].rows.size(), 2u);
  EXPECT_EQ(rowOf(c.tables[3], "run.seed").values, (std::vector<Json>{"1", "7"}));
  EXPECT_EQ(rowOf(c.tables[3], "own.key").values, (std::vector<Json>{nullptr, ""}));
}

Comparison smallComparison() {
  Comparison c;
  c.names = {"a|b", "\"q\", é"};
  c.tables = {{"Figures", {{"x", {1.0 / 3, nullptr}}, {"text", {"one\ntwo", "3|4"}}}}, {"Settings", {}}};
  return c;
}

TEST(Comparison, MarkdownIsAlignedAndSafe) {
  EXPECT_EQ(markdown(smallComparison()),
            "## Figures\n\n"
            "|      | a\\|b    | \"q\", é |\n"
            "|------|---------|--------|\n"
            "| x    | 0.33333 | –      |\n"
            "| text | one two | 3\\|4   |\n"
            "\n## Settings\n\nnone\n");
}

TEST(Comparison, CsvKeepsEveryBit) {
  EXPECT_EQ(csv(smallComparison()),
            "table,name,\"a|b\",\"\"\"q\"\", é\"\n"
            "\"Figures\",\"x\",0.33333333333333331,\n"
            "\"Figures\",\"text\",\"one\ntwo\",\"3|4\"\n");
}

TEST(Comparison, PageHoldsPathsInTheFrameOfTheFirstRun) {
  const std::vector<RunFolder> runs{runWith(sampleTrajectory(), Json::object()),
                                    runWith(seenFrom({3, -1, 0.7}), Json::object())};
  const Json page = comparisonPage(runs, compareRuns(runs, {"a", "b"}));
  EXPECT_EQ(page["kind"], "comparison");
  EXPECT_EQ(page["runs"][0]["path"], page["runs"][1]["path"]);
  EXPECT_EQ(page["runs"][1]["differences"]["t"], Json({0.0, 1.0, 2.0}));
  EXPECT_FALSE(page["runs"][0].contains("map"));
  EXPECT_EQ(page["tables"].size(), 4u);
}

}  // namespace
}  // namespace submap_slam
