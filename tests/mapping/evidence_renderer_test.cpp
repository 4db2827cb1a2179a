#include <gtest/gtest.h>
#include <submap_slam/mapping/evidence_renderer.h>

#include <cmath>
#include <numeric>

#include "synthetic_scans.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kFree = -0.4, kOccupied = 0.85;

EvidenceParams params() {
  EvidenceParams p;
  p.resolution = 0.1;
  p.max_range = 5;
  p.free_log_odds = kFree;
  p.occupied_log_odds = kOccupied;
  return p;
}

EvidenceGrid render(const LaserPoints& scan, const TPose2D& pose) {
  return renderEvidence({{&scan, pose}}, params());
}

/** Evidence at a position; cells outside the grid are unknown. */
double logOdds(const EvidenceGrid& grid, double x, double y) {
  const float* cell = grid.log_odds.cellByPos(x, y);
  return cell ? static_cast<double>(*cell) : 0;
}
double hits(const EvidenceGrid& grid, double x, double y) {
  const float* cell = grid.hits.cellByPos(x, y);
  return cell ? static_cast<double>(*cell) : 0;
}
double total(const mrpt::containers::CDynamicGrid<float>& grid) {
  return std::accumulate(grid.begin(), grid.end(), 0.0,
                         [](double sum, float v) { return sum + static_cast<double>(v); });
}

TEST(EvidenceRenderer, ABeamFreesWhatItCrossesAndHitsItsEnd) {
  const EvidenceGrid grid =
      render(pointsAt({{0.4f, 0}}), {0.05, 0.05, 0});  // from cell centre to cell centre
  for (const double x : {0.05, 0.15, 0.25, 0.35}) {
    EXPECT_NEAR(logOdds(grid, x, 0.05), kFree, 1e-5) << x;
    EXPECT_NEAR(hits(grid, x, 0.05), 1, 1e-5) << x;
  }
  EXPECT_NEAR(logOdds(grid, 0.45, 0.05), kOccupied, 1e-5);
  EXPECT_NEAR(hits(grid, 0.45, 0.05), 1, 1e-5);
  EXPECT_NEAR(total(grid.hits), 5, 1e-5);
  EXPECT_NEAR(grid.resolution(), 0.1, 1e-12);
}

TEST(EvidenceRenderer, TheHitIsSharedBilinearly) {
  // The end lies at (0.475, 0.06): a quarter of a cell right of a centre and a tenth above.
  const EvidenceGrid grid = render(pointsAt({{0.425f, 0.01f}}), {0.05, 0.05, 0});
  EXPECT_NEAR(logOdds(grid, 0.45, 0.05), 0.75 * 0.9 * kOccupied, 1e-4);
  EXPECT_NEAR(logOdds(grid, 0.55, 0.05), 0.25 * 0.9 * kOccupied, 1e-4);
  EXPECT_NEAR(logOdds(grid, 0.45, 0.15), 0.75 * 0.1 * kOccupied, 1e-4);
  EXPECT_NEAR(hits(grid, 0.55, 0.15), 0.25 * 0.1, 1e-4);
  EXPECT_NEAR(total(grid.hits), 4 + 1, 1e-4);
  EXPECT_NEAR(total(grid.log_odds), 4 * kFree + kOccupied, 1e-4);
}

TEST(EvidenceRenderer, BeamsInAnyDirectionCrossAsManyCellsAsTheyMust) {
  for (int k = 0; k < 37; ++k) {
    const double phi = 0.17 * k;
    const TPose2D pose(0.03, 0.08, phi);
    const EvidenceGrid grid = render(pointsAt({{2.0f, 0}}), pose);
    const auto cell = [](double v) { return static_cast<int>(std::floor(v / 0.1)); };
    const int crossed = std::abs(cell(0.03 + 2 * std::cos(phi)) - cell(0.03)) +
                        std::abs(cell(0.08 + 2 * std::sin(phi)) - cell(0.08));
    EXPECT_NEAR(total(grid.hits), crossed + 1, 1e-3) << phi;
    for (double along = 0.01; along < 1.8; along += 0.05)
      EXPECT_LT(logOdds(grid, 0.03 + along * std::cos(phi), 0.08 + along * std::sin(phi)), 0) << phi;
  }
}

TEST(EvidenceRenderer, ALongBeamIsFreeUpToTheMaximumRangeOnly) {
  const EvidenceGrid grid = render(pointsAt({{7, 0}}), {0.05, 0.05, 0});
  EXPECT_NEAR(logOdds(grid, 4.95, 0.05), kFree, 1e-5);
  EXPECT_EQ(hits(grid, 5.15, 0.05), 0);
  for (const float v : grid.log_odds.data()) EXPECT_LE(v, 0);
  EXPECT_NEAR(total(grid.hits), 50, 1);
}

TEST(EvidenceRenderer, ABeamStartsAtItsScanner) {
  LaserPoints scan = pointsAt({{1, 0.5f}});
  scan.sweeps[0].origin = {0, 0.5};
  const EvidenceGrid grid = render(scan, {0.05, 0.05, M_PI / 2});  // the scanner stands at (−0.45, 0.05)
  EXPECT_NEAR(logOdds(grid, -0.45, 0.05), kFree, 1e-4);
  EXPECT_NEAR(logOdds(grid, -0.45, 0.95), kFree, 1e-4);
  EXPECT_NEAR(logOdds(grid, -0.45, 1.05), kOccupied, 1e-3);
  EXPECT_EQ(hits(grid, 0.05, 0.05), 0);
}

TEST(EvidenceRenderer, EvidenceAddsUpWithoutSaturation) {
  const LaserPoints scan = pointsAt({{0.4f, 0}});
  const EvidenceGrid grid = renderEvidence(std::vector<PlacedScan>(500, {&scan, {0.05, 0.05, 0}}), params());
  EXPECT_NEAR(logOdds(grid, 0.45, 0.05), 500 * kOccupied, 0.1);
  EXPECT_NEAR(logOdds(grid, 0.15, 0.05), 500 * kFree, 0.1);
  EXPECT_NEAR(hits(grid, 0.15, 0.05), 500, 1e-3);
}

TEST(EvidenceRenderer, UnobservedCellsHaveNoEvidenceAndTheGridIsCropped) {
  const World room = boxRoom();
  const LaserPoints scan = scanFrom(room, {});
  const EvidenceGrid grid = render(scan, {});
  for (std::size_t i = 0; i < grid.cells(); ++i)
    if (grid.hits.data()[i] == 0) {
      EXPECT_EQ(grid.log_odds.data()[i], 0);
    }
  EXPECT_EQ(grid.cropped().cells(), grid.cells());
  EXPECT_NEAR(grid.hits.getXMin(), -2.7, 0.11);
  EXPECT_NEAR(grid.hits.getYMax(), 2.1, 0.11);
}

TEST(EvidenceRenderer, NothingGivesNothing) {
  EXPECT_EQ(renderEvidence({}, params()).observedCells(), 0u);
  const LaserPoints none;
  EXPECT_EQ(render(none, {1, 2, 3}).observedCells(), 0u);
}

TEST(EvidenceRenderer, FarPosesOnNegativeSidesAreRenderedAlike) {
  const LaserPoints scan = pointsAt({{0.4f, 0}});
  const EvidenceGrid grid = render(scan, {-123.35, -45.65, 0});
  EXPECT_NEAR(logOdds(grid, -123.35, -45.65), kFree, 1e-4);
  EXPECT_NEAR(logOdds(grid, -122.95, -45.65), kOccupied, 1e-3);
  EXPECT_NEAR(total(grid.hits), 5, 1e-3);
}

}  // namespace
}  // namespace submap_slam
