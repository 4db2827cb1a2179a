#include <gtest/gtest.h>
#include <submap_slam/mapping/correlative_search.h>

#include <algorithm>
#include <cmath>

#include "synthetic_scans.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

SurfelMap mapOf(const LaserPoints& scan) {
  SurfelMap map{SurfelMapParams{}};
  map.insert(scan, {});
  return map;
}

/** A wall along x at y = 1 with pillars 0.3 m deep each `pitch` metres. */
LaserPoints comb(float pitch) {
  LaserPoints out = wallPoints(-3, 1, 3, 1);
  for (float x = -3; x <= 3; x += pitch) {
    const auto tooth = wallPoints(x, 0.7f, x, 1).points;
    out.points.insert(out.points.end(), tooth.begin(), tooth.end());
  }
  out.sweeps[0].end = out.points.size();
  return out;
}

bool hasPeakNear(const std::vector<CorrelativePeak>& peaks, const TPose2D& pose) {
  return std::any_of(peaks.begin(), peaks.end(), [&](const auto& p) {
    return distance(p.pose, pose) < 0.04 && turn(p.pose, pose) < 0.04;
  });
}

TEST(CorrelativeSearch, FindsThePoseWithinOneStep) {
  const CorrelativeSearchParams params;
  const World room = boxRoom();
  const SurfelMap map = mapOf(scanFrom(room, {}));
  const LaserPoints scan = scanFrom(room, {0.1, -0.05, 0.2});
  for (const TPose2D& centre : {TPose2D{0.1, -0.05, 0.2}, {0.22, -0.18, 0.5}, {-0.05, 0.1, -0.15}}) {
    const auto peaks = correlativeSearch(map, scan, centre, params);
    ASSERT_FALSE(peaks.empty());
    EXPECT_LE(std::abs(peaks[0].pose.x - 0.1), params.step_xy);
    EXPECT_LE(std::abs(peaks[0].pose.y + 0.05), params.step_xy);
    EXPECT_LE(turn(peaks[0].pose, {0, 0, 0.2}), params.step_phi);
    EXPECT_GT(peaks[0].score, 0.8);
    EXPECT_LE(peaks[0].score, 1);
  }
}

TEST(CorrelativeSearch, HeadingsStayWrapped) {
  const World room = boxRoom();
  const SurfelMap map = mapOf(scanFrom(room, {}));
  const auto peaks = correlativeSearch(map, scanFrom(room, {0, 0, -M_PI + 0.1}), {0, 0, M_PI - 0.1}, {});
  EXPECT_LE(turn(peaks[0].pose, {0, 0, -M_PI + 0.1}), 0.021);
  for (const auto& peak : peaks) EXPECT_LE(std::abs(peak.pose.phi), M_PI);
}

TEST(CorrelativeSearch, APeriodicWallHasSeveralPeaks) {
  CorrelativeSearchParams params;
  params.window_xy = 0.6;
  params.max_beams = 1000;
  const LaserPoints scan = comb(0.5f);
  const auto peaks = correlativeSearch(mapOf(scan), scan, {}, params);
  for (const double x : {-0.5, 0.0, 0.5}) EXPECT_TRUE(hasPeakNear(peaks, {x, 0, 0})) << x;
  EXPECT_FALSE(hasPeakNear(peaks, {0.25, 0, 0}));
  EXPECT_LT(distance(peaks[0].pose, {}), 0.04) << "the one that overlaps whole";
}

TEST(CorrelativeSearch, PeaksAreSortedAndLimited) {
  CorrelativeSearchParams params;
  params.window_xy = 0.6;
  params.max_peaks = 3;
  params.peak_ratio = 0.5;
  const LaserPoints scan = comb(0.5f);
  const auto peaks = correlativeSearch(mapOf(scan), scan, {}, params);
  EXPECT_EQ(peaks.size(), 3u);
  EXPECT_TRUE(std::is_sorted(peaks.begin(), peaks.end(),
                             [](const auto& a, const auto& b) { return a.score > b.score; }));
  for (const auto& peak : peaks) EXPECT_GE(peak.score, 0.5 * peaks[0].score);
}

TEST(CorrelativeSearch, NeverLeavesTheWindow) {
  const World room = boxRoom();
  const CorrelativeSearchParams params;
  const auto peaks = correlativeSearch(mapOf(scanFrom(room, {})), scanFrom(room, {}), {0.6, 0, 0}, params);
  for (const auto& peak : peaks) {
    EXPECT_LE(std::abs(peak.pose.x - 0.6), params.window_xy + 1e-9);
    EXPECT_LE(std::abs(peak.pose.y), params.window_xy + 1e-9);
    EXPECT_LE(std::abs(peak.pose.phi), params.window_phi + 1e-9);
  }
}

TEST(CorrelativeSearch, NothingToMatchScoresZero) {
  const SurfelMap nothing{SurfelMapParams{}};
  const World room = boxRoom();
  const auto no_map = correlativeSearch(nothing, scanFrom(room, {}), {1, 2, 3}, {});
  const auto no_scan = correlativeSearch(mapOf(scanFrom(room, {})), LaserPoints{}, {1, 2, 3}, {});
  for (const auto& peaks : {no_map, no_scan}) {
    ASSERT_FALSE(peaks.empty());
    EXPECT_LE(peaks.size(), 8u);
    for (const auto& peak : peaks) EXPECT_EQ(peak.score, 0);
  }
}

}  // namespace
}  // namespace submap_slam
