#include <gtest/gtest.h>
#include <mrpt/poses/CPose3D.h>
#include <submap_slam/mapping/laser_points.h>

#include <cmath>
#include <limits>

namespace submap_slam {
namespace {

using mrpt::obs::CObservation2DRangeScan;

CObservation2DRangeScan::Ptr scanOf(const std::vector<float>& ranges, double aperture) {
  auto scan = CObservation2DRangeScan::Create();
  scan->aperture = static_cast<float>(aperture);
  scan->resizeScanAndAssign(ranges.size(), 0.0f, true);
  for (std::size_t i = 0; i < ranges.size(); ++i) scan->setScanRange(i, ranges[i]);
  return scan;
}

Frame frameOf(std::vector<CObservation2DRangeScan::Ptr> scans) {
  Frame frame;
  frame.scans = std::move(scans);
  return frame;
}

void expectPoint(const LaserPoint& p, double x, double y) {
  EXPECT_NEAR(p.x, x, 1e-5);
  EXPECT_NEAR(p.y, y, 1e-5);
}

/** A scanner that sees a wall along the line n·p = d, n = (cos α, sin α), from −60° to 60° around n. */
CObservation2DRangeScan::Ptr flatWall(double alpha, double d) {
  constexpr int kBeams = 121;
  const double aperture = 2 * M_PI / 3;
  std::vector<float> ranges;
  for (int i = 0; i < kBeams; ++i)
    ranges.push_back(static_cast<float>(d / std::cos(-aperture / 2 + i * aperture / (kBeams - 1))));
  auto scan = scanOf(ranges, aperture);
  scan->sensorPose = mrpt::poses::CPose3D(0, 0, 0, alpha, 0, 0);
  return scan;
}

TEST(LaserPoints, FirstAndLastBeamLieAtTheEndsOfTheAperture) {
  const auto out = toLaserPoints(frameOf({scanOf({1, 2, 3}, M_PI)}), 100);
  ASSERT_EQ(out.points.size(), 3u);
  expectPoint(out.points[0], 0, -1);
  expectPoint(out.points[1], 2, 0);
  expectPoint(out.points[2], 0, 3);
}

TEST(LaserPoints, SensorPoseMovesAndTurns) {
  auto scan = scanOf({1, 2, 3}, M_PI);
  scan->sensorPose = mrpt::poses::CPose3D(0.5, -0.25, 0.3, M_PI / 2, 0, 0);
  const auto out = toLaserPoints(frameOf({scan}), 100);
  expectPoint(out.points[0], 1.5, -0.25);
  expectPoint(out.points[1], 0.5, 1.75);
  expectPoint(out.points[2], -2.5, -0.25);
  ASSERT_EQ(out.sweeps.size(), 1u);
  EXPECT_NEAR(out.sweeps[0].origin.x(), 0.5, 1e-9);
  EXPECT_NEAR(out.sweeps[0].origin.y(), -0.25, 1e-9);
}

TEST(LaserPoints, ClockwiseScannersStartAtTheLeft) {
  auto scan = scanOf({1, 2, 3}, M_PI);
  scan->rightToLeft = false;
  const auto out = toLaserPoints(frameOf({scan}), 100);
  expectPoint(out.points[0], 0, 1);
  expectPoint(out.points[2], 0, -3);
}

TEST(LaserPoints, UpsideDownScannersSeeMirrored) {
  for (const bool right_to_left : {true, false})
    for (const double yaw : {0.0, 0.7, -2.5}) {
      auto scan = scanOf({1, 2, 3, 4, 5}, 2.5);
      scan->rightToLeft = right_to_left;
      scan->sensorPose = mrpt::poses::CPose3D(0.2, 0.1, 0.4, yaw, 0, M_PI);
      const auto out = toLaserPoints(frameOf({scan}), 100);
      for (std::size_t i = 0; i < 5; ++i) {
        // The same endpoint by MRPT's three-dimensional pose.
        const double angle = (right_to_left ? 1 : -1) * (-1.25 + 2.5 / 4 * static_cast<double>(i));
        const double range = static_cast<double>(i + 1);
        mrpt::math::TPoint3D expected;
        scan->sensorPose.composePoint({range * std::cos(angle), range * std::sin(angle), 0}, expected);
        expectPoint(out.points[i], expected.x, expected.y);
      }
    }
}

TEST(LaserPoints, BeamsWithoutAReturnAreDropped) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInfinite = std::numeric_limits<float>::infinity();
  auto scan = scanOf({1, 0, kNan, 2, kInfinite, -1, 3, 40.1f, 4}, M_PI);
  scan->setScanRangeValidity(6, false);
  const auto out = toLaserPoints(frameOf({scan}), 40);
  ASSERT_EQ(out.points.size(), 3u);
  EXPECT_NEAR(std::hypot(out.points[0].x, out.points[0].y), 1, 1e-5);
  EXPECT_NEAR(std::hypot(out.points[1].x, out.points[1].y), 2, 1e-5);
  EXPECT_NEAR(std::hypot(out.points[2].x, out.points[2].y), 4, 1e-5);
  EXPECT_EQ(out.sweeps[0].end, 3u);
}

TEST(LaserPoints, NothingFromNoScanAndNoBeams) {
  EXPECT_TRUE(toLaserPoints(Frame{}, 10).sweeps.empty());
  const auto out = toLaserPoints(frameOf({scanOf({}, M_PI), scanOf({0, 0}, M_PI)}), 10);
  EXPECT_TRUE(out.points.empty());
}

TEST(LaserPoints, EachScannerHasItsOwnSweep) {
  auto rear = scanOf({5, 6}, M_PI);
  rear->sensorPose = mrpt::poses::CPose3D(-0.4, 0, 0, M_PI, 0, 0);
  const auto out = toLaserPoints(frameOf({scanOf({1, 2, 3}, M_PI), rear}), 100);
  ASSERT_EQ(out.sweeps.size(), 2u);
  EXPECT_EQ(out.sweeps[0].begin, 0u);
  EXPECT_EQ(out.sweeps[0].end, 3u);
  EXPECT_EQ(out.sweeps[1].begin, 3u);
  EXPECT_EQ(out.sweeps[1].end, 5u);
  EXPECT_NEAR(out.sweeps[1].origin.x(), -0.4, 1e-9);
  expectPoint(out.points[3], -0.4, 5);
}

TEST(LaserPoints, NormalsOfAFlatWallPointAcrossIt) {
  for (const double alpha : {0.0, 0.4, M_PI / 2, 2.0, -3.0}) {
    const auto out = toLaserPoints(frameOf({flatWall(alpha, 2)}), 100);
    ASSERT_EQ(out.points.size(), 121u);
    for (const auto& p : out.points) {
      // Towards the scanner, with the cosine of the angle of incidence for length.
      const double incidence = (p.x * std::cos(alpha) + p.y * std::sin(alpha)) / std::hypot(p.x, p.y);
      EXPECT_NEAR(p.normal_x, -incidence * std::cos(alpha), 1e-3) << alpha;
      EXPECT_NEAR(p.normal_y, -incidence * std::sin(alpha), 1e-3) << alpha;
    }
  }
}

TEST(LaserPoints, NoNormalInACornerNorForALonePoint) {
  // 45° beams into a corner at (1, 1) and one far beam between two invalid ones.
  const float inner = 1 / std::cos(0.25f);
  const auto corner =
      toLaserPoints(frameOf({[&] {
                      auto scan = scanOf({inner, static_cast<float>(std::sqrt(2.0)), inner}, 0.5);
                      scan->sensorPose = mrpt::poses::CPose3D(0, 0, 0, M_PI / 4, 0, 0);
                      return scan;
                    }()}),
                    100);
  // The neighbours of the corner point lie 0.25 rad away on walls at right angles.
  const auto& p = corner.points[1];
  EXPECT_EQ(p.normal_x, 0);
  EXPECT_EQ(p.normal_y, 0);

  const auto lone = toLaserPoints(frameOf({scanOf({0, 3, 0}, 1)}), 100);
  EXPECT_EQ(lone.points[0].normal_x, 0);
  EXPECT_EQ(lone.points[0].normal_y, 0);
}

TEST(LaserPoints, NoNormalAcrossAGap) {
  const auto out = toLaserPoints(frameOf({scanOf({1, 5, 1}, 0.1)}), 100);
  for (const auto& p : out.points) EXPECT_EQ(std::hypot(p.normal_x, p.normal_y), 0);
}

}  // namespace
}  // namespace submap_slam
