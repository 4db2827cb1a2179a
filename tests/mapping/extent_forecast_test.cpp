#include <gtest/gtest.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/mapping/extent_forecast.h>
#include <submap_slam/mapping/stretch_splitter.h>

#include <algorithm>
#include <cmath>

#include "mapped_log.h"
#include "synthetic_scans.h"

namespace submap_slam {
namespace {

/** Along x through a world, a frame each 5 cm. */
std::vector<Frame> driven(const World& world, double metres) {
  Path path{0.1, {}};
  for (int i = 0; i <= static_cast<int>(std::lround(metres / 0.05)); ++i)
    path.poses.emplace_back(-0.5 * metres + 0.05 * i, 0, 0);
  return simulate(world, path, exactLaser(), OdometryModel::perfect(), 1).frames;
}

ExtentForecast foretold(const std::vector<Frame>& frames, const GridMapperParams& mapper) {
  ExtentForecast forecast(mapper);
  forecast.begin(frames.front());
  for (std::size_t i = 1; i < frames.size(); ++i) forecast.add(frames[i]);
  return forecast;
}

/** Matches are perfect; what is left is the floor, s² per metre in x and y and q² per metre in heading. */
GridMapperParams onlyFloor(double s, double q) {
  GridMapperParams mapper;
  mapper.drift = {1e-9, 1e-9, s, q};
  return mapper;
}

TEST(ExtentForecast, BlurIsTheMeanSquareMotionOfSurfacesAlongTheirNormals) {
  const auto frames = driven(endlessCorridor(), 3);
  const double s = 0.01, q = 0.004;
  // Normals are (0, ±1): a shift moves a wall by its y, a turn by x.
  const LaserPoints last = toLaserPoints(frames.back(), 1e9);
  double xx = 0;
  for (const auto& p : last.points) xx += std::pow(static_cast<double>(p.x), 2);
  const double mean_xx = xx / static_cast<double>(last.points.size());
  EXPECT_NEAR(foretold(frames, onlyFloor(s, q)).blur(), std::sqrt(3 * (s * s + q * q * mean_xx)), 1e-4);
}

TEST(ExtentForecast, DriftAlongACorridorBlursNothing) {
  GridMapperParams mapper;
  mapper.drift = {0.06, 1, 0, 0};  // odometry alone knows how far: 3 cm and more after 3 m
  const auto corridor = foretold(driven(endlessCorridor(), 3), mapper);
  EXPECT_GT(corridor.blur(), 0);
  EXPECT_LT(corridor.blur(), 0.005);
}

TEST(ExtentForecast, NothingSeenBlursNothingAndNeverEnds) {
  auto frames = driven(boxRoom(), 2);
  for (auto& frame : frames) frame.scans.clear();
  const auto forecast = foretold(frames, {});
  EXPECT_EQ(forecast.blur(), 0);
  EXPECT_EQ(forecast.overlap(), 1);
}

TEST(ExtentForecast, OverlapIsSightOverSightAndPath) {
  const auto frames = driven(boxRoom(), 2);
  double sum = 0, beams = 0;
  for (std::size_t i = 0; i < frames.size(); i += 3)  // key scans each 0.15 m
    for (const auto& p : toLaserPoints(frames[i], 1e9).points)
      sum += std::hypot(static_cast<double>(p.x), static_cast<double>(p.y)), beams += 1;
  EXPECT_NEAR(foretold(frames, {}).overlap(), sum / beams / (sum / beams + 2), 1e-3);

  GridMapperParams short_sighted;
  short_sighted.evidence.max_range = 1;
  EXPECT_NEAR(foretold(frames, short_sighted).overlap(), 1.0 / 3, 1e-2) << "evidence ends there";
}

TEST(ExtentForecast, BeginsAnewWithEachSubmap) {
  const auto frames = driven(boxRoom(), 2);
  ExtentForecast twice = foretold(frames, {});
  twice.begin(frames.front());
  for (std::size_t i = 1; i < frames.size(); ++i) twice.add(frames[i]);
  EXPECT_EQ(twice.blur(), foretold(frames, {}).blur());
  EXPECT_EQ(twice.overlap(), foretold(frames, {}).overlap());
}

StretchParams automatic() {
  StretchParams params;
  params.extent = "auto";
  params.max_distance = 0.1;  // must not matter
  params.max_nodes = 1'000'000;
  return params;
}

std::vector<Frame> loopLog(double metres) {
  const auto log = simulateRoute(loopWorld(), metres, OdometryModel::perfect(), 1);
  return log.frames;
}

TEST(AutomaticExtent, StaysBetweenItsBoundsOfOverlap) {
  const auto frames = loopLog(40);
  for (const double max_blur : {1e-6, 1e6}) {
    StretchParams params = automatic();
    params.max_blur = max_blur;
    const auto stretches = stretchesOf(frames, params);
    ASSERT_GT(stretches.size(), 2u);
    for (const auto& stretch : stretches) {
      if (stretch.last) continue;
      const std::vector<Frame> own(stretch.frames.begin() + static_cast<std::ptrdiff_t>(stretch.warm_up),
                                   stretch.frames.end());
      const double overlap = foretold(own, {}).overlap();
      const double before = foretold({own.begin(), own.end() - 1}, {}).overlap();
      if (max_blur < 1) {
        EXPECT_LE(overlap, params.max_overlap);
        EXPECT_GT(before, params.max_overlap) << "ends as soon as it may";
      } else {
        EXPECT_LT(overlap, params.min_overlap);
        EXPECT_GE(before, params.min_overlap) << "goes on as long as it may";
      }
    }
  }
}

TEST(AutomaticExtent, EndsWhereTheBlurSays) {
  StretchParams params = automatic();
  params.min_overlap = 0.01, params.max_overlap = 0.99;
  GridMapperParams mapper = onlyFloor(0.01, 0);
  mapper.evidence.resolution = 0.1;
  params.max_blur = 0.2;  // 0.02 m = 0.01 m/√m · √(4 m)
  StretchSplitter splitter(params, mapper);
  std::size_t frames = 0, stretches = 0;
  for (const auto& frame : driven(endlessCorridor(), 13)) {
    ++frames;
    if (!splitter.push(frame)) continue;
    ++stretches;
    EXPECT_NEAR(0.05 * static_cast<double>(frames - 1), 4.0 * static_cast<double>(stretches), 0.25);
  }
  EXPECT_EQ(stretches, 3u);
}

TEST(AutomaticExtent, BoundariesDoNotDependOnWhatFollows) {
  auto frames = loopLog(40);
  const auto whole = stretchesOf(frames, automatic());
  frames.resize(frames.size() * 2 / 3);
  const auto part = stretchesOf(frames, automatic());
  ASSERT_GT(part.size(), 2u);
  for (std::size_t k = 0; k + 1 < part.size(); ++k) {
    EXPECT_EQ(part[k].frames.front().index, whole[k].frames.front().index);
    EXPECT_EQ(part[k].ownFrames(), whole[k].ownFrames());
  }
}

TEST(AutomaticExtent, WithoutOdometryTheNodesCount) {
  auto frames = loopLog(10);
  for (auto& frame : frames) frame.odometry.reset();
  StretchParams params = automatic();
  params.max_nodes = 20;
  for (const auto& stretch : stretchesOf(frames, params)) EXPECT_LE(stretch.ownFrames(), 20u);
}

TEST(AutomaticExtent, BoundsThatContradictEachOtherAreRefused) {
  StretchParams params = automatic();
  params.min_overlap = params.max_overlap;
  EXPECT_THROW(StretchSplitter{params}, ConfigError);
}

}  // namespace
}  // namespace submap_slam
