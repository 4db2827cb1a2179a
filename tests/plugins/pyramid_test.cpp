#include "grid_gauss_newton/pyramid.h"

#include <gtest/gtest.h>

#include "synthetic_submaps.h"

namespace submap_slam::grid_joining {
namespace {

EvidenceGrid gridWith(std::initializer_list<std::tuple<unsigned, unsigned, float, float>> cells) {
  EvidenceGrid grid(-1, 1, -1, 1, 0.1);
  for (const auto& [x, y, log_odds, hits] : cells) {
    *grid.log_odds.cellByIndex(x, y) = log_odds;
    *grid.hits.cellByIndex(x, y) = hits;
  }
  return grid;
}

TEST(EvidenceLevel, KeepsObservedCellsWithARim) {
  const EvidenceGrid grid = gridWith({{3, 5, 1.5f, 2.0f}, {7, 6, -4.0f, 5.0f}});
  const EvidenceLevel level = EvidenceLevel::fromGrid(grid);
  EXPECT_EQ(level.columns(), 5 + 2);
  EXPECT_EQ(level.rows(), 2 + 2);
  const double u = level.columnOf(grid.log_odds.idx2x(7)), v = level.rowOf(grid.log_odds.idx2y(6));
  EXPECT_NEAR(u, 5, 1e-12);
  EXPECT_NEAR(v, 2, 1e-12);
  EXPECT_EQ(level.cell(5, 2).log_odds, -4.0f);
  EXPECT_EQ(level.cell(1, 1).hits, 2.0f);
  EXPECT_EQ(level.cell(0, 0).hits, 0.0f);
  EXPECT_TRUE(EvidenceLevel::fromGrid(EvidenceGrid(-1, 1, -1, 1, 0.1)).empty());
}

TEST(EvidenceLevel, InterpolatesBilinearlyWithItsGradient) {
  const EvidenceLevel level = EvidenceLevel::fromGrid(
      gridWith({{3, 5, 1.0f, 2.0f}, {4, 5, 3.0f, 4.0f}, {3, 6, 5.0f, 6.0f}, {4, 6, 11.0f, 8.0f}}));
  const EvidenceSample s = level.sample(1.25, 1.5);
  EXPECT_NEAR(s.log_odds, 0.5 * (0.75 * 1 + 0.25 * 3) + 0.5 * (0.75 * 5 + 0.25 * 11), 1e-12);
  EXPECT_NEAR(s.hits, 0.5 * 2.5 + 0.5 * 6.5, 1e-12);
  EXPECT_NEAR(s.log_odds_gradient[0], 0.5 * (2 + 6) / 0.1, 1e-9);
  EXPECT_NEAR(s.log_odds_gradient[1], (0.75 * 4 + 0.25 * 8) / 0.1, 1e-9);
  EXPECT_NEAR(s.hits_gradient[0], 2 / 0.1, 1e-9);
  EXPECT_NEAR(s.hits_gradient[1], 4 / 0.1, 1e-9);
}

TEST(EvidenceLevel, HalvingSumsTwoByTwoCellsInPlace) {
  const EvidenceLevel fine = EvidenceLevel::fromGrid(gridWith(
      {{2, 2, 1.0f, 1.0f}, {3, 2, 2.0f, 1.0f}, {2, 3, 4.0f, 1.0f}, {3, 3, 8.0f, 1.0f}, {4, 3, 16.0f, 3.0f}}));
  const EvidenceLevel coarse = fine.halved();
  EXPECT_NEAR(coarse.resolution(), 0.2, 1e-12);
  EXPECT_EQ(coarse.columns(), 2 + 2);
  EXPECT_EQ(coarse.rows(), 1 + 2);
  EXPECT_EQ(coarse.cell(1, 1).log_odds, 15.0f);
  EXPECT_EQ(coarse.cell(1, 1).hits, 4.0f);
  EXPECT_EQ(coarse.cell(2, 1).log_odds, 16.0f);
  // its centre is the middle of the four cells
  EXPECT_NEAR(coarse.xOf(1), 0.5 * (fine.xOf(1) + fine.xOf(2)), 1e-12);
  EXPECT_NEAR(coarse.yOf(1), 0.5 * (fine.yOf(1) + fine.yOf(2)), 1e-12);
}

TEST(EvidenceLevel, StandardisingKeepsTheLogOddsPerHit) {
  EvidenceLevel level = EvidenceLevel::fromGrid(gridWith({{2, 2, 18.0f, 9.0f}}));
  level.standardise();
  EXPECT_FLOAT_EQ(level.cell(1, 1).hits, 3.0f);
  EXPECT_FLOAT_EQ(level.cell(1, 1).log_odds, 6.0f);
}

TEST(Pyramid, FinestLevelKeepsSumsAndCoarserOnesAreStandardised) {
  const GridSubmaps submaps{testing::roughSubmap(1, 3, 2, 0.1), testing::roughSubmap(2, 2, 2, 0.1)};
  const auto from_half = buildPyramid(submaps, 1, 3), whole = buildPyramid(submaps, 0, 1);
  ASSERT_EQ(from_half.size(), 3u);
  ASSERT_EQ(from_half[2].size(), 2u);
  const EvidenceLevel& fine = from_half[0][1];
  EvidenceLevel expected = whole[0][1].halved();
  EXPECT_NEAR(fine.resolution(), 0.2, 1e-12);
  EXPECT_EQ(fine.cell(3, 4).log_odds, expected.cell(3, 4).log_odds);
  expected = expected.halved();
  expected.standardise();
  EXPECT_EQ(from_half[1][1].cell(2, 3).log_odds, expected.cell(2, 3).log_odds);
  EXPECT_EQ(from_half[1][1].cell(2, 3).hits, expected.cell(2, 3).hits);
}

}  // namespace
}  // namespace submap_slam::grid_joining
