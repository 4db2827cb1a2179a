#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/poses/CPose2D.h>

#include <cmath>

#include "imported.h"

namespace submap_slam {
namespace {

using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationOdometry;
using testing::HasSubstr;

const std::string kHeader =
    "# my robot\nangle_min -1.0\nangle_increment 0.5\nrange_max 8\nsensor_pose 0.1 0 0.25\n";

TEST(ScanText, HasStampsOdometryAndAngles) {
  const auto log = importText(kHeader + "100.5 1 2 0.5 3 4 5 6 7\n101 2 2 0.5 3 4 5 8.0 inf\n");
  const auto scans = log.all<CObservation2DRangeScan>();
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_NEAR(seconds(*scans[0]), 100.5, 1e-6);
  EXPECT_NEAR(scans[0]->aperture, 2, 1e-6);
  EXPECT_NEAR(scans[0]->sensorPose.yaw(), 0.25, 1e-6);  // the beams are symmetric
  EXPECT_NEAR(scans[0]->sensorPose.x(), 0.1, 1e-6);
  EXPECT_FLOAT_EQ(scans[0]->getScanRange(3), 6);
  EXPECT_TRUE(scans[0]->getScanRangeValidity(4));
  EXPECT_FALSE(scans[1]->getScanRangeValidity(3));
  EXPECT_FALSE(scans[1]->getScanRangeValidity(4));
  const auto odometry = log.all<CObservationOdometry>();
  ASSERT_EQ(odometry.size(), 2u);
  EXPECT_NEAR(odometry[1]->odometry.x(), 2, 1e-9);
}

TEST(ScanText, BeamsFromLeftToRight) {
  const auto scan = importText("angle_min 1\nangle_increment -0.5\nrange_max 8\n1 0 0 0 3 4 5 6 7\n")
                        .all<CObservation2DRangeScan>()
                        .at(0);
  EXPECT_NEAR(scan->sensorPose.yaw() + scan->getScanAngle(0), 1, 1e-6);
  EXPECT_NEAR(scan->sensorPose.yaw() + scan->getScanAngle(4), -1, 1e-6);
}

TEST(ScanText, OdometryMayBeMissing) {
  const auto log = importText(kHeader + "odometry none\n1 3 4 5 6 7\n");
  EXPECT_EQ(log.objects.size(), 1u);
  EXPECT_FLOAT_EQ(log.all<CObservation2DRangeScan>().at(0)->getScanRange(0), 3);
}

TEST(ScanText, DamagedLinesAreLeftOut) {
  const auto log =
      importText(kHeader + "1 0 0 0 3 4 5 6 7\n2 0 0 0 3 4 5 6\n3 nan 0 0 3 4 5 6 7\n4 0 0 0 3 4 5 6 7\n");
  EXPECT_EQ(log.all<CObservation2DRangeScan>().size(), 2u);
  ASSERT_EQ(log.report.damage.size(), 2u);
  EXPECT_THAT(log.report.damage[0], HasSubstr("a.log:7: 4 ranges: expected 5 as in the first scan"));
  EXPECT_THAT(log.report.damage[1], HasSubstr("a.log:8: 'nan' for x by odometry: expected a finite number"));
}

TEST(ScanText, RefusesAnIncompleteHeader) {
  EXPECT_THAT(refusal("angle_min -1\nrange_max 8\n1 0 0 0 3 4\n"), HasSubstr("no angle_increment before"));
  EXPECT_THAT(refusal("angle_min -1\nangle_increment 1\n1 0 0 0 3 4\n"), HasSubstr("no range_max"));
  EXPECT_THAT(refusal("angle_min -1\nangle_increment 0\nrange_max 8\n1 0 0 0 3 4\n"),
              HasSubstr("angle_increment is 0"));
  EXPECT_THAT(refusal(kHeader), HasSubstr("holds nothing that can be used"));
  EXPECT_THAT(importText(kHeader + "range_mix 3\n1 0 0 0 3 4 5 6 7\n").report.damage.at(0),
              HasSubstr("a.log:6: 'range_mix': expected a stamp or one of angle_min"));
}

}  // namespace
}  // namespace submap_slam
