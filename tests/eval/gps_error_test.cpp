#include <gmock/gmock.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/eval/gps_error.h>

#include <cmath>

#include "../support/temp_folder.h"

namespace submap_slam {
namespace {

constexpr double kPi = 3.141592653589793;

/** A quarter of a circle with radius 10 m, heading along it. */
TimedTrajectory quarterCircle() {
  std::vector<TimedPose> poses;
  for (int k = 0; k <= 90; ++k) {
    const double angle = k * kPi / 180;
    poses.push_back(
        {static_cast<double>(k), toPose3D({10 * std::sin(angle), 10 - 10 * std::cos(angle), angle})});
  }
  return TimedTrajectory(poses);
}

/** Where an antenna 2 m ahead and 1 m to the left is then, in a frame turned by 90° and moved. */
std::vector<GpsFix> fixesOfQuarterCircle() {
  std::vector<GpsFix> fixes;
  for (int k = 0; k <= 90; k += 5) {
    const double angle = k * kPi / 180;
    const double x = 10 * std::sin(angle) + 2 * std::cos(angle) - std::sin(angle);
    const double y = 10 - 10 * std::cos(angle) + 2 * std::sin(angle) + std::cos(angle);
    fixes.push_back({static_cast<double>(k), {100 - y, 50 + x}});
  }
  return fixes;
}

TEST(GpsError, IsZeroForTheRightAntennaInAnyFrame) {
  EXPECT_LT(gpsError(quarterCircle(), fixesOfQuarterCircle(), {2, 1}).distance_m.max, 1e-9);
  EXPECT_GT(gpsError(quarterCircle(), fixesOfQuarterCircle(), {0, 0}).distance_m.rmse, 0.1);
}

TEST(GpsError, FixesWithoutAPoseAreCounted) {
  auto fixes = fixesOfQuarterCircle();
  fixes.push_back({500, {0, 0}});
  const auto error = gpsError(quarterCircle(), fixes, {2, 1});
  EXPECT_EQ(error.unused, 1u);
  EXPECT_EQ(error.distance_m.count, 19u);
  EXPECT_EQ(gpsError(quarterCircle(), {}, {2, 1}).distance_m.count, 0u);
}

TEST(GpsOutliers, AreAloneInTheWild) {
  const std::vector<GpsFix> fixes{{0, {0, 0}}, {1, {1, 0}},    {2, {-250, 0}},
                                  {3, {3, 0}}, {60, {200, 0}}, {61, {201, 0}}};
  const auto kept = withoutOutliers(fixes);  // the jump over a gap in time stays: two fixes say so
  ASSERT_EQ(kept.size(), 5u);
  EXPECT_EQ(kept[2].t, 3);
}

TEST(GpsFile, IsReadAndNamedWhereItIsWrong) {
  TempFolder temp;
  const auto fixes = readGps(temp.write("gps.txt", "# t x y\n1000000000.5 -67.6 -41.7\n1 2 3\n"));
  ASSERT_EQ(fixes.size(), 2u);
  EXPECT_EQ(fixes[0].position.x, -67.6);
  EXPECT_THROW(readGps(temp.write("bad.txt", "1 2\n")), InputError);
}

}  // namespace
}  // namespace submap_slam
