#include <gmock/gmock.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/landmarks/pole_detector.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

namespace submap_slam {
namespace {

using mrpt::obs::CObservation2DRangeScan;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kPi = 3.141592653589793;
constexpr double kEmpty = 81.91;

/** 181 beams of 1° over 180°, all empty but these: first beam, and ranges (m) of it and the next ones. */
struct Hit {
  std::size_t beam;
  std::vector<double> ranges;
};

CObservation2DRangeScan scanWith(const std::vector<Hit>& hits) {
  CObservation2DRangeScan scan;
  scan.aperture = static_cast<float>(kPi);
  scan.maxRange = 80;
  scan.rightToLeft = true;
  scan.resizeScanAndAssign(181, static_cast<float>(kEmpty), false);
  for (const Hit& hit : hits)
    for (std::size_t i = 0; i < hit.ranges.size(); ++i) {
      scan.setScanRange(hit.beam + i, static_cast<float>(hit.ranges[i]));
      scan.setScanRangeValidity(hit.beam + i, true);
    }
  return scan;
}

std::vector<Pole> polesIn(const std::vector<Hit>& hits) { return detectPoles(scanWith(hits), {}); }

TEST(PoleDetector, HandWorkedPole) {
  // beams 90 to 92 at 10 m: 3° wide with a beam's width, so 0.5236 m; the middle beam 1° to the left
  const auto poles = polesIn({{90, {10, 9.9, 10}}});
  ASSERT_THAT(poles, SizeIs(1));
  const double diameter = 3 * kPi / 180 * 10;
  EXPECT_NEAR(poles[0].diameter, diameter, 1e-6);
  EXPECT_NEAR(poles[0].range, 9.9 + diameter / 2, 1e-6);
  EXPECT_NEAR(poles[0].bearing, kPi / 180, 1e-9);
}

TEST(PoleDetector, OfTwoMiddleBeamsTheMeanCounts) {
  const auto poles = polesIn({{90, {10, 9.8, 9.6, 10}}});
  ASSERT_THAT(poles, SizeIs(1));
  EXPECT_NEAR(poles[0].range, 9.7 + poles[0].diameter / 2, 1e-6);
  EXPECT_NEAR(poles[0].bearing, 1.5 * kPi / 180, 1e-9);
}

TEST(PoleDetector, EmptyScansHaveNone) {
  EXPECT_THAT(polesIn({}), IsEmpty());
  EXPECT_THAT(detectPoles(CObservation2DRangeScan{}, {}), IsEmpty());
  CObservation2DRangeScan single;
  single.resizeScanAndAssign(1, 5, true);
  EXPECT_THAT(detectPoles(single, {}), IsEmpty());
}

TEST(PoleDetector, LeavesOutWhatIsNoPole) {
  EXPECT_THAT(polesIn({{90, {0.9, 0.9}}}), IsEmpty()) << "too near";
  EXPECT_THAT(polesIn({{90, {75.5}}}), IsEmpty()) << "too far";
  EXPECT_THAT(polesIn({{90, {20, 20, 20, 20}}}), IsEmpty()) << "too wide: 1.05 m from the first to the last";
  EXPECT_THAT(polesIn({{90, {20, 20, 20}}}), SizeIs(1)) << "0.7 m";
  EXPECT_THAT(polesIn({{1, {10, 10}}}), IsEmpty()) << "at the first beams";
  EXPECT_THAT(polesIn({{178, {10, 10}}}), IsEmpty()) << "at the last beams";
  EXPECT_THAT(polesIn({{90, {10, 10.2}}}), IsEmpty()) << "aslant: 0.2 m over 0.35 m";
  EXPECT_THAT(polesIn({{90, {10, 10.1}}}), SizeIs(1));
}

TEST(PoleDetector, GroupsAreNone) {
  EXPECT_THAT(polesIn({{60, {10, 10}}, {70, {10, 10}}}), IsEmpty()) << "1.6 m apart";
  EXPECT_THAT(polesIn({{60, {10, 10}}, {80, {10, 10}}}), SizeIs(2)) << "3.3 m apart";
  // the fourth one is compared with three before it, the fifth one no more
  EXPECT_THAT(polesIn({{60, {10}}, {63, {30}}, {66, {50}}, {69, {10}}}), SizeIs(2));
  EXPECT_THAT(polesIn({{60, {10}}, {63, {30}}, {66, {50}}, {69, {70}}, {72, {10}}}), SizeIs(5));
}

TEST(PoleDetector, WhatMayBeHiddenIsLeftOut) {
  PoleDetectorParams params;
  params.min_gap = 1.5 * kPi / 180;
  const auto poles = detectPoles(scanWith({{90, {10, 10}}, {92, {20}}}), params);
  ASSERT_THAT(poles, SizeIs(1));
  EXPECT_LT(poles[0].range, 11);
  EXPECT_LT(detectPoles(scanWith({{89, {20}}, {90, {10, 10}}}), params).at(0).range, 11);
}

TEST(PoleDetector, RespectsHowTheScannerIsMounted) {
  auto scan = scanWith({{100, {10, 10, 10}}});
  scan.sensorPose = mrpt::poses::CPose3D(1, 2, 0.5, 0.3, 0, 0);
  const double bearing = 11 * kPi / 180;
  EXPECT_NEAR(poleLandmarks(scan, {}).measurements.at(0).bearing, bearing, 1e-9);
  EXPECT_NEAR(poleLandmarks(scan, {}).T_robot_sensor.phi, 0.3, 1e-9);
  EXPECT_FALSE(poleLandmarks(scan, {}).measurements[0].id);
  scan.rightToLeft = false;
  EXPECT_NEAR(poleLandmarks(scan, {}).measurements.at(0).bearing, -bearing, 1e-9);
  scan.sensorPose = mrpt::poses::CPose3D(0, 0, 0.5, 0, 0, kPi);
  EXPECT_NEAR(poleLandmarks(scan, {}).measurements.at(0).bearing, bearing, 1e-9);
}

TEST(PoleDetector, FindsThePublishedDetectionsOfVictoriaPark) {
  const std::string file = SHARED_DATA "/victoria_park/victoria_park_observations.rawlog";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
  mrpt::io::CFileGZInputStream in(file);
  auto archive = mrpt::serialization::archiveFrom(in);
  std::size_t scans = 0, published = 0, found = 0, agreed = 0;
  std::vector<Pole> poles;
  while (scans < 7230 || published < 52792) {
    const auto object = archive.ReadObject();
    if (const auto scan = std::dynamic_pointer_cast<CObservation2DRangeScan>(object)) {
      poles = detectPoles(*scan, {});
      found += poles.size();
      ++scans;
    }
    const auto trees = std::dynamic_pointer_cast<mrpt::obs::CObservationBearingRange>(object);
    if (!trees) continue;
    published += trees->sensedData.size();
    for (std::size_t i = 0; i < std::min(poles.size(), trees->sensedData.size()); ++i)
      agreed += std::abs(static_cast<double>(trees->sensedData[i].range) - poles[i].range) < 1e-4 &&
                std::abs(static_cast<double>(trees->sensedData[i].yaw) - poles[i].bearing) < 1e-5;
  }
  EXPECT_EQ(published, 52792u);
  EXPECT_EQ(found, published);
  EXPECT_EQ(agreed, published);
}

}  // namespace
}  // namespace submap_slam
