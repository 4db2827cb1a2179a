#include "grid_gauss_newton/pyramid.h"

#include <gmock/gmock.h>
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

EvidenceRaster rasterOf(const EvidenceGrid& grid, double background = 0) {
  return EvidenceRaster::fromEvidence(PackedEvidence(grid), background);
}

TEST(EvidenceRaster, KeepsObservedCellsWithARim) {
  const EvidenceGrid grid = gridWith({{3, 5, 1.5f, 2.0f}, {7, 6, -4.0f, 5.0f}});
  const EvidenceRaster raster = rasterOf(grid);
  EXPECT_EQ(raster.columns, 5 + 2);
  EXPECT_EQ(raster.rows, 2 + 2);
  EXPECT_NEAR(raster.x0 + 5 * raster.resolution, grid.log_odds.idx2x(7), 1e-12);
  EXPECT_NEAR(raster.y0 + 2 * raster.resolution, grid.log_odds.idx2y(6), 1e-12);
  EXPECT_EQ(raster.cell(5, 2).log_odds, -4.0f);
  EXPECT_EQ(raster.cell(1, 1).hits, 2.0f);
  EXPECT_EQ(raster.cell(0, 0).hits, 0.0f);
  EXPECT_TRUE(rasterOf(EvidenceGrid(-1, 1, -1, 1, 0.1)).cells.empty());
}

TEST(EvidenceRaster, TakesTheBackgroundOff) {
  const EvidenceRaster raster = rasterOf(gridWith({{2, 2, -1.2f, 3.0f}, {3, 2, 1.0f, 2.0f}}), -0.4);
  EXPECT_EQ(raster.cell(1, 1).log_odds, 0.0f) << "rounding must not leave anything";
  EXPECT_EQ(raster.cell(1, 1).hits, 3.0f);
  EXPECT_FLOAT_EQ(raster.cell(2, 1).log_odds, 1.8f);
}

TEST(EvidenceRaster, HalvingSumsTwoByTwoCellsInPlace) {
  const EvidenceRaster fine = rasterOf(gridWith(
      {{2, 2, 1.0f, 1.0f}, {3, 2, 2.0f, 1.0f}, {2, 3, 4.0f, 1.0f}, {3, 3, 8.0f, 1.0f}, {4, 3, 16.0f, 3.0f}}));
  const EvidenceRaster coarse = fine.halved();
  EXPECT_NEAR(coarse.resolution, 0.2, 1e-12);
  EXPECT_EQ(coarse.columns, 2 + 2);
  EXPECT_EQ(coarse.rows, 1 + 2);
  EXPECT_EQ(coarse.cell(1, 1).log_odds, 15.0f);
  EXPECT_EQ(coarse.cell(1, 1).hits, 4.0f);
  EXPECT_EQ(coarse.cell(2, 1).log_odds, 16.0f);
  // its centre is the middle of the four cells
  EXPECT_NEAR(coarse.x0 + coarse.resolution, fine.x0 + 1.5 * fine.resolution, 1e-12);
  EXPECT_NEAR(coarse.y0 + coarse.resolution, fine.y0 + 1.5 * fine.resolution, 1e-12);
}

TEST(EvidenceRaster, StandardisingKeepsTheLogOddsPerHit) {
  EvidenceRaster raster = rasterOf(gridWith({{2, 2, 18.0f, 9.0f}}));
  raster.standardise();
  EXPECT_FLOAT_EQ(raster.cell(1, 1).hits, 3.0f);
  EXPECT_FLOAT_EQ(raster.cell(1, 1).log_odds, 6.0f);
}

TEST(EvidenceLevel, InterpolatesBilinearlyWithItsGradient) {
  const EvidenceGrid grid =
      gridWith({{3, 5, 1.0f, 2.0f}, {4, 5, 3.0f, 4.0f}, {3, 6, 5.0f, 6.0f}, {4, 6, 11.0f, 8.0f}});
  const EvidenceLevel level(rasterOf(grid));
  EXPECT_NEAR(level.columnOf(grid.log_odds.idx2x(4)), 2, 1e-12);
  EXPECT_NEAR(level.rowOf(grid.log_odds.idx2y(6)), 2, 1e-12);
  const EvidenceSample s = level.sample(1.25, 1.5);
  EXPECT_NEAR(s.log_odds, 0.5 * (0.75 * 1 + 0.25 * 3) + 0.5 * (0.75 * 5 + 0.25 * 11), 1e-12);
  EXPECT_NEAR(s.hits, 0.5 * 2.5 + 0.5 * 6.5, 1e-12);
  EXPECT_NEAR(s.log_odds_gradient[0], 0.5 * (2 + 6) / 0.1, 1e-9);
  EXPECT_NEAR(s.log_odds_gradient[1], (0.75 * 4 + 0.25 * 8) / 0.1, 1e-9);
  EXPECT_NEAR(s.hits_gradient[0], 2 / 0.1, 1e-9);
  EXPECT_NEAR(s.hits_gradient[1], 4 / 0.1, 1e-9);
}

/** Over the borders of blocks, next to unknown blocks, in free space and far outside. */
TEST(EvidenceLevel, IsTheRasterEverywhere) {
  EvidenceGrid grid = testing::roughSubmap(5, 4.3, 3.1, 0.1)->evidence;
  for (unsigned cy = 0; cy < grid.sizeY(); ++cy) {
    for (unsigned cx = 7; cx < 23; ++cx)  // a gap of several blocks
      *grid.log_odds.cellByIndex(cx, cy) = *grid.hits.cellByIndex(cx, cy) = 0;
    for (unsigned cx = 23; cx < 34; ++cx)  // and no surfaces beside it
      *grid.log_odds.cellByIndex(cx, cy) = 0;
  }
  const EvidenceRaster raster = rasterOf(grid);
  const EvidenceLevel level(raster);
  EXPECT_LT(level.blocks().size(), 5u * 6u) << "blocks of the gap are not stored";
  for (int r = -9; r < raster.rows + 9; ++r)
    for (int c = -9; c < raster.columns + 9; ++c) {
      const bool inside = r >= 0 && c >= 0 && r < raster.rows && c < raster.columns;
      const EvidenceCell expected = inside ? raster.cell(c, r) : EvidenceCell{};
      const EvidenceSample s = level.sample(c, r);
      EXPECT_EQ(s.hits, static_cast<double>(expected.hits)) << c << " " << r;
      EXPECT_EQ(s.log_odds, static_cast<double>(expected.log_odds)) << c << " " << r;
    }
  EXPECT_EQ(level.sample(1e6, -1e6).hits, 0);
}

TEST(EvidenceLevel, SurfaceBitsSayWhereALookUpSeesMoreThanBackground) {
  const EvidenceLevel level(rasterOf(gridWith({{2, 2, 0.0f, 1.0f}, {9, 4, 5.0f, 1.0f}})));
  // The raster's cell (8, 3) is above the background: look-ups from four cells reach it.
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 16; ++c) {
      const EvidenceBlockTable table = level.tableAt(c, r);
      const bool bit = table.blocks[*table.numbers].surface >> (8 * (r % 8) + c % 8) & 1;
      EXPECT_EQ(bit, (c == 7 || c == 8) && (r == 2 || r == 3)) << c << " " << r;
    }
}

TEST(Background, IsTheLeastLogOddsPerHit) {
  auto a = GridSubmap::Create(), b = GridSubmap::Create();
  a->evidence = gridWith({{2, 2, -3.0f, 10.0f}, {4, 4, 8.0f, 4.0f}});
  b->evidence = gridWith({{2, 2, -2.0f, 5.0f}});
  EXPECT_FLOAT_EQ(static_cast<float>(backgroundOf({a, b})), -0.4f);
  auto empty = GridSubmap::Create();
  EXPECT_EQ(backgroundOf({empty}), 0);
}

TEST(Pyramid, FinestLevelKeepsSumsAndCoarserOnesAreStandardised) {
  const GridSubmaps submaps{testing::roughSubmap(1, 3, 2, 0.1), testing::roughSubmap(2, 2, 2, 0.1)};
  const auto pyramid = buildPyramid(submaps, {1, 3, 0});
  ASSERT_EQ(pyramid.size(), 3u);
  ASSERT_EQ(pyramid[2].size(), 2u);
  EvidenceRaster expected = rasterOf(submaps[1]->evidence).halved();
  EXPECT_NEAR(pyramid[0][1].resolution(), 0.2, 1e-12);
  EXPECT_EQ(pyramid[0][1].sample(3, 4).log_odds, static_cast<double>(expected.cell(3, 4).log_odds));
  expected = expected.halved();
  expected.standardise();
  EXPECT_EQ(pyramid[1][1].sample(2, 3).log_odds, static_cast<double>(expected.cell(2, 3).log_odds));
  EXPECT_EQ(pyramid[1][1].sample(2, 3).hits, static_cast<double>(expected.cell(2, 3).hits));
}

TEST(Pyramid, IsTheSameFromUnloadedSubmaps) {
  const GridSubmaps submaps{testing::roughSubmap(1, 3, 2, 0.1)};
  const auto before = buildPyramid(submaps, {0, 1, 0});
  submaps[0]->unload();
  const auto after = buildPyramid(submaps, {0, 1, 0});
  EXPECT_FALSE(submaps[0]->evidenceIsLoaded());
  EXPECT_EQ(before[0][0].sample(7.3, 5.6).log_odds, after[0][0].sample(7.3, 5.6).log_odds);
}

TEST(Pyramid, FinerSubmapsKeepTheirSums) {
  const GridSubmaps submaps{testing::roughSubmap(1, 3, 2, 0.1), testing::roughSubmap(2, 3, 2, 0.05)};
  EXPECT_THAT(halvingsToCoarsest(submaps), ::testing::ElementsAre(0, 1));
  const EvidenceLevels level = buildPyramid(submaps, {0, 1, 0}).front();
  EXPECT_NEAR(level[1].resolution(), 0.1, 1e-12);
  double before = 0, after = 0;
  for (const float hits : submaps[1]->evidence.hits.data()) before += static_cast<double>(hits);
  for (int row = 0; row < 25; ++row)
    for (int column = 0; column < 35; ++column) after += level[1].sample(column, row).hits;
  EXPECT_NEAR(after, before, 1e-3);
}

}  // namespace
}  // namespace submap_slam::grid_joining
