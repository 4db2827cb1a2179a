#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <submap_slam/eval/mapping_progress.h>

#include <cmath>
#include <stdexcept>

namespace submap_slam {
namespace {

using mrpt::poses::CPose2D;
using mrpt::poses::CPosePDFGaussian;

/** A submap that observed a square of `side` m ahead and to the left of its frame. */
GridSubmap::Ptr squareSubmap(uint32_t id, double side, std::size_t scans, std::size_t nodes) {
  auto submap = GridSubmap::Create();
  submap->id = id;
  submap->evidence = EvidenceGrid(0, side, 0, side, 0.1);
  submap->evidence.hits.fill(1.0f);
  submap->nodes.resize(scans);
  for (std::size_t n = 0; n < nodes; ++n)
    submap->nodes[n].scans.push_back(mrpt::obs::CObservation2DRangeScan::Create());
  return submap;
}

CPosePDFGaussian frameAt(double x, double y, double phi) {
  CPosePDFGaussian frame;
  frame.mean = CPose2D(x, y, phi);
  return frame;
}

/** 2 × 2 m; the same again half covered; within the first one; 2 × 2 m apart from all: areas 4, 6, 6, 10 m².
 */
std::vector<SubmapProgress> fourSubmaps() {
  GridSubmaps submaps{squareSubmap(0, 2, 10, 4), squareSubmap(1, 2, 20, 5), squareSubmap(2, 1, 5, 5),
                      squareSubmap(3, 2, 15, 1)};
  const float means[] = {0.5f, 0.75f, 0.25f, 1.0f};
  for (std::size_t k = 0; k < 4; ++k) {
    submaps[k]->statistics.match_score_mean = means[k];
    submaps[k]->statistics.match_score_min = means[k] - 0.25f;
    submaps[k]->statistics.match_score_max = means[k];
  }
  return mappingProgress(submaps, {frameAt(0, 0, 0), frameAt(1, 0, 0), frameAt(0, 0, 0), frameAt(10, 0, 0)});
}

TEST(MappingProgress, CountsWhatEachSubmapAdds) {
  const auto progress = fourSubmaps();
  const double expected[] = {0.4, 0.6, 0.6, 1.0};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(progress[k].map_share, expected[k], 0.02) << k;
  EXPECT_EQ(progress[3].map_share, 1.0);
  EXPECT_EQ(progress[2].id, 2u);
  EXPECT_EQ(progress[1].scans, 20u);
  EXPECT_EQ(progress[2].nodes, 5u);
  EXPECT_EQ(progress[2].nodes_sum, 14u);
  EXPECT_DOUBLE_EQ(progress[1].scan_share, 0.6);
  EXPECT_DOUBLE_EQ(progress[3].scan_share, 1.0);
}

TEST(MappingProgress, DoesNotDependOnWhereTheMapIsNorOnUnloading) {
  GridSubmaps submaps{squareSubmap(0, 6, 1, 1), squareSubmap(1, 6, 1, 1)};
  submaps[1]->unload();
  // Squares side by side, turned by 30°: each adds half.
  const CPose2D T_w_first(5, -3, M_PI / 6);
  CPosePDFGaussian second;
  second.mean = T_w_first + CPose2D(6, 0, 0);
  const auto progress = mappingProgress(submaps, {frameAt(5, -3, M_PI / 6), second});
  EXPECT_NEAR(progress[0].map_share, 0.5, 0.02);
  EXPECT_FALSE(submaps[1]->evidenceIsLoaded());
}

TEST(MappingProgress, ScoresAreMeansOverScans) {
  const MatchScores scores = overallScores(fourSubmaps());
  EXPECT_NEAR(scores.mean, (10 * 0.5 + 20 * 0.75 + 5 * 0.25 + 15 * 1.0) / 50, 1e-6);
  EXPECT_EQ(scores.min, 0.0);
  EXPECT_EQ(scores.max, 1.0);
}

TEST(MappingProgress, StagesEndWithSubmaps) {
  const auto progress = fourSubmaps();
  const auto shares = stageShares(progress, 3);  // after 2, 3 and 4 submaps
  ASSERT_EQ(shares.size(), 3u);
  EXPECT_EQ(shares[0], progress[1].map_share);
  EXPECT_EQ(shares[1], progress[2].map_share);
  EXPECT_EQ(shares[2], 1.0);
}

TEST(MappingProgress, NothingIsNoTrouble) {
  EXPECT_TRUE(mappingProgress({}, {}).empty());
  EXPECT_TRUE(stageShares({}, 5).empty());
  EXPECT_EQ(overallScores({}).mean, 0.0);
  const auto blind = mappingProgress({GridSubmap::Create()}, {CPosePDFGaussian()});
  EXPECT_EQ(blind[0].map_share, 0.0);
  EXPECT_EQ(overallScores(blind).max, 0.0);
  EXPECT_THROW(mappingProgress({GridSubmap::Create()}, {}), std::invalid_argument);
}

TEST(MappingProgress, CsvHasALineForEachSubmap) {
  SubmapProgress first, second;
  first.scans = 10, first.nodes = first.nodes_sum = 4, first.score = {0.5, 0.25, 0.75};
  first.map_share = 0.4, first.scan_share = 0.5;
  second = first;
  second.id = 1, second.nodes_sum = 8, second.map_share = second.scan_share = 1;
  EXPECT_EQ(progressCsv({first, second}),
            "id,scans,nodes,nodes_sum,score_mean,score_min,score_max,scan_share,map_share,map_share_gain\n"
            "0,10,4,4,0.5000,0.2500,0.7500,0.5000,0.4000,0.4000\n"
            "1,10,4,8,0.5000,0.2500,0.7500,1.0000,1.0000,0.6000\n");
}

}  // namespace
}  // namespace submap_slam
