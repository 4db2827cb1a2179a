#include <gtest/gtest.h>
#include <submap_slam/eval/grid_scores.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace submap_slam {
namespace {

/** A row of cells of 0.1 m from x_min on, with the given probabilities of being occupied; 0.5 is unknown. */
EvidenceGrid row(double x_min, const std::vector<double>& occupied) {
  const double x_max = x_min + 0.1 * static_cast<double>(occupied.size());
  EvidenceGrid grid(x_min, x_max, 0, 0.1, 0.1);
  for (std::size_t i = 0; i < occupied.size(); ++i) {
    if (occupied[i] == 0.5) continue;
    *grid.log_odds.cellByIndex(static_cast<unsigned>(i), 0) =
        static_cast<float>(std::log(occupied[i] / (1 - occupied[i])));
    *grid.hits.cellByIndex(static_cast<unsigned>(i), 0) = 1;
  }
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

TEST(GridScores, TellApartWhatIsAsGoodAsCertain) {
  // Log-odds of −30 and −60: an 8-bit grid would call them equal.
  const double free = 1 / (1 + std::exp(30.0)), freer = 1 / (1 + std::exp(60.0));
  EXPECT_EQ(*scoreGrid(row(0, {free, freer}), row(0, {0.9, 0.1})).auc, 1);
  EXPECT_EQ(*scoreGrid(row(0, {freer, free}), row(0, {0.9, 0.1})).auc, 0);
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
  const EvidenceGrid fine(0, 0.4, 0, 0.1, 0.05);
  EXPECT_THROW(scoreGrid(fine, row(0, {0.1, 0.9})), std::invalid_argument);
}

}  // namespace
}  // namespace submap_slam
