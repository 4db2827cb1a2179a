#include <gtest/gtest.h>
#include <submap_slam/eval/grid_scores.h>

#include <stdexcept>
#include <vector>

namespace submap_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

/** A row of cells of 0.1 m from x_min on, with the given probabilities of being occupied; 0.5 is unknown. */
COccupancyGridMap2D row(double x_min, const std::vector<double>& occupied) {
  const double x_max = x_min + 0.1 * static_cast<double>(occupied.size());
  COccupancyGridMap2D grid(static_cast<float>(x_min), static_cast<float>(x_max), 0.0f, 0.1f, 0.1f);
  for (std::size_t i = 0; i < occupied.size(); ++i)
    if (occupied[i] != 0.5) grid.setCell(static_cast<int>(i), 0, static_cast<float>(1 - occupied[i]));
  return grid;
}

TEST(GridScores, HandWorked) {
  // Occupied cells look 0.9, 0.6, 0.2 occupied, free ones 0.7, 0.2, 0.1. Of the nine pairs 3 + 2 + 1.5 are in
  // order.
  const auto scores =
      scoreGrid(row(0, {0.9, 0.6, 0.2, 0.7, 0.2, 0.1}), row(0, {0.99, 0.8, 0.6, 0.1, 0.3, 0.4}));
  EXPECT_EQ(scores.cells, 6u);
  EXPECT_EQ(scores.occupied, 3u);
  EXPECT_NEAR(*scores.auc, 6.5 / 9, 1e-12);
  EXPECT_NEAR(*scores.precision, 2.0 / 3, 1e-12);
  EXPECT_NEAR(*scores.recall, 2.0 / 3, 1e-12);
  EXPECT_NEAR(*scores.accuracy, 4.0 / 6, 1e-12);
  EXPECT_EQ(scores.coverage, 1);
}

TEST(GridScores, LeaveOutWhatEitherGridDoesNotKnow) {
  const auto scores = scoreGrid(row(0, {0.9, 0.5, 0.1, 0.9}), row(0, {0.9, 0.9, 0.1, 0.5}));
  EXPECT_EQ(scores.cells, 2u);
  EXPECT_NEAR(scores.coverage, 2.0 / 3, 1e-12);
  EXPECT_EQ(*scores.auc, 1);
  EXPECT_EQ(*scores.precision, 1);
}

TEST(GridScores, CompareTheSamePlaceWhateverTheExtents) {
  const auto truth = row(-0.2, {0.1, 0.9, 0.1, 0.9});
  EXPECT_EQ(*scoreGrid(row(-0.1, {0.9, 0.1, 0.9, 0.9}), truth).accuracy, 1);
  EXPECT_EQ(scoreGrid(row(-0.1, {0.9, 0.1, 0.9, 0.9}), truth).cells, 3u);
  EXPECT_EQ(*scoreGrid(row(0.0, {0.9, 0.1}), truth).accuracy, 0);
}

TEST(GridScores, AreOpenWhereNothingCanBeSaid) {
  const auto free_only = scoreGrid(row(0, {0.1, 0.2}), row(0, {0.1, 0.2}));
  EXPECT_FALSE(free_only.auc);
  EXPECT_FALSE(free_only.precision);
  EXPECT_EQ(*free_only.accuracy, 1);
  const auto apart = scoreGrid(row(5, {0.1, 0.9}), row(0, {0.1, 0.9}));
  EXPECT_EQ(apart.cells, 0u);
  EXPECT_EQ(apart.coverage, 0);
  EXPECT_FALSE(apart.accuracy);
}

TEST(GridScores, RefuseGridsOfDifferentResolution) {
  COccupancyGridMap2D fine(0.0f, 0.4f, 0.0f, 0.1f, 0.05f);
  EXPECT_THROW(scoreGrid(fine, row(0, {0.1, 0.9})), std::invalid_argument);
}

}  // namespace
}  // namespace submap_slam
