#include <gtest/gtest.h>
#include <submap_slam/matching/map_agreement.h>

#include <array>
#include <cmath>

namespace submap_slam {
namespace {

/** Free in [0, 4] × [0, 4] with a wall in the column of cells from x = 2, unknown elsewhere. */
AgreementMap wall(const AgreementParams& params = {}) {
  EvidenceGrid grid(0, 6, 0, 4, 0.1);
  for (std::size_t y = 0; y < grid.sizeY(); ++y)
    for (std::size_t x = 0; x < 40; ++x) {
      const auto ix = static_cast<unsigned>(x), iy = static_cast<unsigned>(y);
      *grid.hits.cellByIndex(ix, iy) = 5;
      *grid.log_odds.cellByIndex(ix, iy) = x == 20 ? 2.0f : -2.0f;
    }
  return AgreementMap(PackedEvidence(grid), params);
}

LaserPoints at(std::initializer_list<std::pair<float, float>> points) {
  LaserPoints out;
  for (const auto& [x, y] : points) out.points.push_back({x, y, 0, 0});
  return out;
}

TEST(MapAgreement, CountsHitsContradictionsAndTheUnknown) {
  // Two on the wall (one 0.1 m off), one in free space, one where nothing was seen.
  const auto points = at({{2.05f, 1}, {2.15f, 2}, {1, 1}, {5, 1}});
  const MapAgreement out = agreementOf(points, wall({0.1, 2}), {});
  EXPECT_DOUBLE_EQ(out.hit_share, 2.0 / 4);
  EXPECT_DOUBLE_EQ(out.agreement, 2.0 / 3);
}

TEST(MapAgreement, PlacesThePoints) {
  const auto points = at({{1, 0.05f}, {2, 0.05f}});
  const MapAgreement out = agreementOf(points, wall({0.05, 2}), {2.1, 0, M_PI / 2});
  EXPECT_DOUBLE_EQ(out.hit_share, 1);
}

TEST(MapAgreement, NothingToCompareIsNoContradiction) {
  const MapAgreement none = agreementOf({}, wall(), {});
  EXPECT_EQ(none.hit_share, 0);
  EXPECT_EQ(none.agreement, 1);
  const MapAgreement apart = agreementOf(at({{1, 1}}), wall(), {100, 100, 0});
  EXPECT_EQ(apart.hit_share, 0);
  EXPECT_EQ(apart.agreement, 1);
}

TEST(AgreementMap, FindsWhatAWalkOverTheCellsFinds) {
  const AgreementParams params{0.3, 2};
  EvidenceGrid grid(-1.7, 2.1, -0.9, 2.6, 0.1);
  for (std::size_t k = 0; k < grid.cells(); ++k) {
    const auto i = static_cast<std::ptrdiff_t>(k);
    grid.hits.begin()[i] = static_cast<float>(k * k % 7 % 4);
    if (grid.hits.begin()[i] > 0) grid.log_odds.begin()[i] = k * k % 61 == 1 ? 1.0f : -1.0f;
  }
  const PackedEvidence evidence(grid);
  const AgreementMap map(evidence, params);
  std::array<int, 3> found{};
  for (int cy = -12; cy < evidence.sizeY() + 12; ++cy)
    for (int cx = -12; cx < evidence.sizeX() + 12; ++cx) {
      auto expected =
          evidence.cell(cx, cy).second >= 2 ? AgreementMap::Finding::kFree : AgreementMap::Finding::kUnknown;
      for (int y = cy - 3; y <= cy + 3; ++y)
        for (int x = cx - 3; x <= cx + 3; ++x)
          if (evidence.cell(x, y).first > 0) expected = AgreementMap::Finding::kHit;
      const auto finding = map.at(evidence.xMin() + 0.1 * (cx + 0.5), evidence.yMin() + 0.1 * (cy + 0.5));
      EXPECT_EQ(finding, expected) << cx << ", " << cy;
      ++found[static_cast<std::size_t>(finding)];
    }
  for (const int times : found) EXPECT_GT(times, 30);
}

}  // namespace
}  // namespace submap_slam
