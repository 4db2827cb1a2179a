#include <gtest/gtest.h>
#include <submap_slam/matching/branch_and_bound.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace submap_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/** A grid with random walls, free space and holes where nothing was seen. */
PackedEvidence randomEvidence(uint32_t seed) {
  std::mt19937 random(seed);
  EvidenceGrid grid(-3, 4, -2, 5, 0.1);
  for (std::size_t k = 0; k < grid.cells(); ++k) {
    const auto kind = static_cast<uint32_t>(random() % 20);
    if (kind > 14) continue;
    *(grid.hits.begin() + static_cast<std::ptrdiff_t>(k)) = 3;
    *(grid.log_odds.begin() + static_cast<std::ptrdiff_t>(k)) = kind == 0 ? 2.0f : -1.0f;
  }
  return PackedEvidence(grid);
}

std::vector<TPoint2D> randomPoints(uint32_t seed, std::size_t count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-2, 2);
  std::vector<TPoint2D> points;
  while (points.size() < count) points.emplace_back(coordinate(random), coordinate(random));
  return points;
}

double scoreAt(const ScorePyramid& map, const std::vector<TPoint2D>& points, const TPose2D& pose) {
  double sum = 0;
  for (const auto& p : points) {
    const TPoint2D at = pose.composePoint(p);
    sum += map.score(0, static_cast<int>(std::floor(map.column(at.x))),
                     static_cast<int>(std::floor(map.row(at.y))));
  }
  return sum / (255 * static_cast<double>(points.size()));
}

TEST(ScorePyramid, CoarseCellsHoldTheBestOfTheFineOnes) {
  const ScorePyramid map(randomEvidence(1), {0.2, 5, 0.27});
  for (int level = 1; level < map.levels(); ++level)
    for (int row = -40; row < 60; row += 3)
      for (int column = -40; column < 60; column += 3) {
        uint8_t best = 0;
        for (int r = row; r < row + (1 << level); ++r)
          for (int c = column; c < column + (1 << level); ++c) best = std::max(best, map.score(0, c, r));
        ASSERT_EQ(map.score(level, column, row), best) << level << " " << column << " " << row;
      }
}

TEST(ScorePyramid, UnknownFreeAndOccupied) {
  EvidenceGrid grid(0, 1, 0, 1, 0.1);
  *grid.hits.cellByIndex(0, 0) = 1, *grid.log_odds.cellByIndex(0, 0) = -1;
  *grid.hits.cellByIndex(5, 5) = 1, *grid.log_odds.cellByIndex(5, 5) = 1;
  *grid.hits.cellByIndex(4, 5) = 1, *grid.log_odds.cellByIndex(4, 5) = -1;
  const ScorePyramid map(PackedEvidence(grid), {0.2, 1, 0.25});
  EXPECT_EQ(map.score(0, 0, 0), 0);
  EXPECT_EQ(map.score(0, 2, 2), 255);
  EXPECT_EQ(map.score(0, 3, 3), 64);
  EXPECT_EQ(map.score(0, -100, 1 << 20), 64);
}

/** What a search of cells of 0.2 m tries in a window of less than 7 cells. */
std::vector<TPose2D> allPoses(const PoseWindow& window, const std::vector<TPoint2D>& points) {
  double farthest = 0;
  for (const auto& p : points) farthest = std::max(farthest, p.norm());
  const int turns = static_cast<int>(std::ceil(window.half_phi * farthest / 0.2));
  std::vector<TPose2D> poses;
  for (int turn = -turns; turn <= turns; ++turn)
    for (int dy = -7; dy <= 7; ++dy)
      for (int dx = -7; dx <= 7; ++dx)
        poses.emplace_back(window.centre.x + 0.2 * dx, window.centre.y + 0.2 * dy,
                           window.centre.phi + turn * window.half_phi / turns);
  return poses;
}

/** Branch and bound must find what looking everywhere finds. */
class SearchWindow : public ::testing::TestWithParam<uint32_t> {};

TEST_P(SearchWindow, FindsTheBestOfAllPoses) {
  const uint32_t seed = GetParam();
  const ScorePyramid map(randomEvidence(seed), {0.2, 6, 0.27});
  const auto points = randomPoints(seed + 100, seed % 2 == 0 ? 25 : 200);
  const PoseWindow window{{0.3, 0.7, 0.4 * seed}, 1.3, 0.35};
  const auto found = searchWindow(map, points, window, 0.1);
  ASSERT_TRUE(found);
  EXPECT_NEAR(scoreAt(map, points, found->pose), found->score, 1e-12);

  double best = 0, best_elsewhere = 0;
  for (const TPose2D& pose : allPoses(window, points)) {
    const double score = scoreAt(map, points, pose);
    best = std::max(best, score);
    const bool elsewhere = std::hypot(pose.x - found->pose.x, pose.y - found->pose.y) > 0.7 ||
                           std::abs(mrpt::math::wrapToPi(pose.phi - found->pose.phi)) > 0.2;
    if (elsewhere) best_elsewhere = std::max(best_elsewhere, score);
  }
  EXPECT_NEAR(found->score, best, 1e-12);
  EXPECT_LE(std::abs(found->pose.x - window.centre.x), 1.4 + 1e-9);
  EXPECT_LE(std::abs(found->pose.y - window.centre.y), 1.4 + 1e-9);
  EXPECT_NEAR(searchRival(map, points, window, *found, {0.7, 0.2, 0.1}), best_elsewhere, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SearchWindow, ::testing::Range(0u, 12u));

TEST(SearchWindow, NothingReachesAScoreThatIsTooHigh) {
  const ScorePyramid map(randomEvidence(1), {0.2, 6, 0.27});
  EXPECT_FALSE(searchWindow(map, randomPoints(1, 30), {{0, 0, 0}, 1, 0.2}, 0.999));
  EXPECT_FALSE(searchWindow(map, {}, {{0, 0, 0}, 1, 0.2}, 0));
}

TEST(SearchWindow, TheSamePlaceTwiceIsARival) {
  EvidenceGrid grid(-5, 5, -5, 5, 0.1);
  for (auto& n : {&grid.hits}) n->fill(2);
  grid.log_odds.fill(-1);
  std::vector<TPoint2D> points;
  for (int k = 0; k < 10; ++k) {
    points.emplace_back(0.05 + 0.1 * k, 0.05);
    points.emplace_back(0.05, 0.05 + 0.1 * k);
    for (const double x : {-3.0, 1.5}) {
      *grid.log_odds.cellByPos(x + 0.05 + 0.1 * k, 0.05) = 3;
      *grid.log_odds.cellByPos(x + 0.05, 0.05 + 0.1 * k) = 3;
    }
  }
  const ScorePyramid map(PackedEvidence(grid), {0.1, 6, 0.27});
  const auto wide = searchWindow(map, points, {{0, 0, 0}, 4, 0.1}, 0.5);
  ASSERT_TRUE(wide);
  EXPECT_NEAR(wide->score, 1, 1e-12);
  EXPECT_NEAR(searchRival(map, points, {{0, 0, 0}, 4, 0.1}, *wide), 1, 1e-12);
  const PoseWindow narrow{{1.5, 0, 0}, 0.8, 0.1};
  const auto alone = searchWindow(map, points, narrow, 0.5);
  ASSERT_TRUE(alone);
  EXPECT_NEAR(alone->pose.x, 1.5, 0.1 + 1e-9);
  EXPECT_EQ(searchRival(map, points, narrow, *alone), 0);
}

}  // namespace
}  // namespace submap_slam
