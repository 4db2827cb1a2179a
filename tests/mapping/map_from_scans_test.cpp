#include <gtest/gtest.h>
#include <mrpt/poses/CPose2D.h>
#include <submap_slam/mapping/map_from_scans.h>
#include <tbb/global_control.h>

#include <numeric>
#include <stdexcept>
#include <vector>

#include "mapped_log.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::poses::CPose2D;

const GridSubmaps& roomSubmaps() {
  static const GridSubmaps submaps = [] {
    StretchParams stretching;
    stretching.max_distance = 6;
    return mapLog(simulateRoute(roomWorld(), 15, OdometryModel{}, 1).frames, {}, 1, stretching);
  }();
  return submaps;
}

/** The first submap alone, its frame at a pose. */
JoinedMap oneSubmapAt(const TPose2D& T_w_s) {
  JoinedMap joined = chainSubmaps({roomSubmaps().front()});
  joined.frames[0].mean = CPose2D(T_w_s);
  return joined;
}

EvidenceGrid drawn(const GridSubmaps& submaps, const JoinedMap& joined) {
  return mapFromScans(submaps, joined, {}, 0).value().unpacked();
}

/** Share of the cells called occupied in a grid that are called so in another. */
double sharedWalls(const EvidenceGrid& of, const EvidenceGrid& in) {
  double all = 0, shared = 0;
  for (unsigned cy = 0; cy < of.sizeY(); ++cy)
    for (unsigned cx = 0; cx < of.sizeX(); ++cx) {
      if (*of.log_odds.cellByIndex(cx, cy) <= 0) continue;
      all += 1;
      const float* there =
          in.log_odds.cellByPos(of.hits.idx2x(static_cast<int>(cx)), of.hits.idx2y(static_cast<int>(cy)));
      if (there && *there > 0) shared += 1;
    }
  return shared / all;
}

void expectEqual(const EvidenceGrid& a, const EvidenceGrid& b) {
  EXPECT_EQ(a.log_odds.getXMin(), b.log_odds.getXMin());
  EXPECT_EQ(a.log_odds.getYMin(), b.log_odds.getYMin());
  EXPECT_EQ(a.sizeX(), b.sizeX());
  EXPECT_EQ(a.log_odds.data(), b.log_odds.data());
  EXPECT_EQ(a.hits.data(), b.hits.data());
}

TEST(MapFromScans, ASubmapAtTheOriginIsItsOwnMap) {
  const EvidenceGrid map = drawn({roomSubmaps().front()}, oneSubmapAt({}));
  const LoadedEvidence evidence(*roomSubmaps().front());
  // But for beams that begin or end on the border of a cell, which rounding puts on either side.
  EXPECT_GT(sharedWalls(*evidence, map), 0.999);
  EXPECT_GT(sharedWalls(map, *evidence), 0.999);
  const auto sum = [](const EvidenceLayer& layer) {
    return std::accumulate(layer.begin(), layer.end(), 0.0,
                           [](double all, float cell) { return all + static_cast<double>(cell); });
  };
  EXPECT_NEAR(sum(map.hits), sum(evidence->hits), 1e-3 * sum(evidence->hits));
  EXPECT_NEAR(sum(map.log_odds), sum(evidence->log_odds), 1e-3 * sum(evidence->hits));
  EXPECT_EQ(map.cropped().cells(), map.cells());
}

TEST(MapFromScans, TakesNoMemoryForBlocksThatNobodySaw) {
  const auto map = mapFromScans({roomSubmaps().front()}, oneSubmapAt({0, 0, 0.41}), {}, 0).value();
  EXPECT_EQ(map.bytes(), PackedEvidence(map.unpacked()).bytes());
}

TEST(MapFromScans, LosesNoWallsWhereTheSubmapIsTurned) {
  // The truth are the same beams drawn from poses that are turned and shifted, without any submap.
  const GridSubmaps one{roomSubmaps().front()};
  const JoinedMap joined = oneSubmapAt({0.523, -0.314, 0.41});
  std::vector<LaserPoints> points;
  std::vector<PlacedScan> placed;
  points.reserve(one[0]->nodes.size());
  const auto scans = one[0]->scans();
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (scans[i].empty()) continue;
    Frame frame;
    frame.scans = scans[i];
    placed.push_back({&points.emplace_back(toLaserPoints(frame, 1e9)),
                      joined.frames[0].mean.asTPose() + one[0]->nodes[i].pose});
  }
  const EvidenceGrid truth = renderEvidence(placed, {});
  EXPECT_GT(sharedWalls(truth, drawn(one, joined)), 0.999);
  EXPECT_LT(sharedWalls(truth, fuseEvidence(one, joined.frames, 0).unpacked()), 0.99);
}

TEST(MapFromScans, NodesAreWhereJoinersMovedThem) {
  const GridSubmaps one{roomSubmaps().front()};
  JoinedMap moved = oneSubmapAt({});
  moved.nodes.resize(1);
  for (const auto& node : one[0]->nodes) moved.nodes[0].push_back(TPose2D(0.5, 0.25, 0) + node.pose);
  expectEqual(drawn(one, moved), drawn(one, oneSubmapAt({0.5, 0.25, 0})));
}

TEST(MapFromScans, IsTheSameForAnyNumberOfThreads) {
  const JoinedMap joined = chainSubmaps(roomSubmaps());
  const EvidenceGrid map = drawn(roomSubmaps(), joined);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  expectEqual(map, drawn(roomSubmaps(), joined));
}

TEST(MapFromScans, TakesTheResolutionThatIsWanted) {
  EXPECT_EQ(mapFromScans(roomSubmaps(), chainSubmaps(roomSubmaps()), {}, 0.2)->resolution(), 0.2);
  EXPECT_EQ(drawn(roomSubmaps(), chainSubmaps(roomSubmaps())).resolution(), 0.05);
}

TEST(MapFromScans, IsNotMadeWhereASubmapKeepsNoScans) {
  GridSubmaps submaps = roomSubmaps();
  const auto bare = std::make_shared<GridSubmap>(*submaps[1]);
  for (auto& node : bare->nodes) node.scans.clear();
  submaps[1] = bare;
  EXPECT_FALSE(mapFromScans(submaps, chainSubmaps(submaps), {}, 0));
}

TEST(MapFromScans, IsNotMadeWithOtherParametersThanTheSubmaps) {
  const JoinedMap joined = chainSubmaps(roomSubmaps());
  GridMapperParams near;
  near.evidence.max_range = 1.5;
  EXPECT_FALSE(mapFromScans(roomSubmaps(), joined, near, 0));
  GridMapperParams surer;
  surer.evidence.occupied_log_odds *= 2;
  EXPECT_FALSE(mapFromScans(roomSubmaps(), joined, surer, 0));
  EXPECT_TRUE(mapFromScans(roomSubmaps(), joined, {}, 0));
}

TEST(MapFromScans, OfNothingIsEmpty) {
  EXPECT_EQ(mapFromScans({}, {}, {}, 0)->observedCells(), 0u);
  EXPECT_THROW(mapFromScans(roomSubmaps(), {}, {}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace submap_slam
