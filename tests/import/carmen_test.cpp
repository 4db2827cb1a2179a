#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/poses/CPose2D.h>
#include <submap_slam/rawlog/rawlog_reader.h>

#include <cmath>
#include <sstream>

#include "imported.h"

namespace submap_slam {
namespace {

using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationOdometry;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kDegree = M_PI / 180;

std::string rangesOf(std::size_t count, double range) {
  std::ostringstream text;
  for (std::size_t i = 0; i < count; ++i) text << ' ' << range;
  return text.str();
}

/** `FLASER` with all ranges 2 m, robot and laser at x. */
std::string flaser(double stamp, double x, std::size_t beams = 180, const std::string& ranges = "") {
  std::ostringstream text;
  text.precision(15);
  text << "FLASER " << beams << (ranges.empty() ? rangesOf(beams, 2) : ranges) << ' ' << x << " 0 0 " << x
       << " 0 0 " << stamp << " host " << stamp - 100 << '\n';
  return text.str();
}

/** Angle of a beam on the robot. */
double angleOf(const CObservation2DRangeScan& scan, std::size_t beam) {
  return scan.sensorPose.yaw() + scan.getScanAngle(beam);
}

TEST(Carmen, OldScanHasStampPoseAndAngles) {
  const auto log = importText(flaser(100.25, 0) + flaser(100.5, 0.1));
  const auto scans = log.all<CObservation2DRangeScan>();
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_NEAR(seconds(*scans[0]), 100.25, 1e-6);
  EXPECT_NEAR(seconds(*scans[1]), 100.5, 1e-6);
  // 180 beams: one per degree from -90 to +89
  EXPECT_NEAR(scans[0]->aperture, 179 * kDegree, 1e-6);
  EXPECT_NEAR(scans[0]->sensorPose.yaw(), -0.5 * kDegree, 1e-6);
  EXPECT_NEAR(angleOf(*scans[0], 0), -90 * kDegree, 1e-6);
  EXPECT_NEAR(angleOf(*scans[0], 179), 89 * kDegree, 1e-6);
  const auto odometry = log.all<CObservationOdometry>();
  ASSERT_EQ(odometry.size(), 2u);
  EXPECT_NEAR(odometry[1]->odometry.x(), 0.1, 1e-9);
  EXPECT_EQ(odometry[1]->timestamp, scans[1]->timestamp);
  EXPECT_EQ(log.objects.front(), odometry.front());  // odometry in front of its scan
  EXPECT_FALSE(log.report.damaged());
}

TEST(Carmen, NumberOfBeamsTellsSicksModes) {
  const auto firstAndLast = [](std::size_t beams) {
    const auto scan = importText(flaser(1, 0, beams)).all<CObservation2DRangeScan>().at(0);
    return std::vector<int>{static_cast<int>(std::lround(angleOf(*scan, 0) / kDegree * 4)),
                            static_cast<int>(std::lround(angleOf(*scan, beams - 1) / kDegree * 4))};
  };
  EXPECT_THAT(firstAndLast(181), ElementsAre(-360, 360));
  EXPECT_THAT(firstAndLast(360), ElementsAre(-360, 358));
  EXPECT_THAT(firstAndLast(361), ElementsAre(-360, 360));
  EXPECT_THAT(firstAndLast(401), ElementsAre(-200, 200));
}

TEST(Carmen, OtherNumbersOfBeamsNeedTheirAngles) {
  EXPECT_THAT(refusal(flaser(1, 0, 100)),
              HasSubstr(":1: 100 readings: the line does not say at which angles"));
  ImportOptions options;
  options.beam_angles = BeamAngles{-45 * kDegree, 1 * kDegree};
  const auto scan = importText(flaser(1, 0, 91), options).all<CObservation2DRangeScan>().at(0);
  EXPECT_NEAR(angleOf(*scan, 0), -45 * kDegree, 1e-6);
  EXPECT_NEAR(angleOf(*scan, 90), 45 * kDegree, 1e-6);
}

TEST(Carmen, NoReturnIsTheCodeOfTheScanner) {
  // SICK with 80 m: 81.83 and 81.91 are codes of error, 79 m is a range
  const auto scan = importText(flaser(1, 0, 181, " 81.91 81.83 79.0 nan -1" + rangesOf(176, 2)))
                        .all<CObservation2DRangeScan>()
                        .at(0);
  EXPECT_FLOAT_EQ(scan->maxRange, 80);
  std::vector<bool> valid;
  for (std::size_t i = 0; i < 6; ++i) valid.push_back(scan->getScanRangeValidity(i));
  EXPECT_THAT(valid, ElementsAre(false, false, true, false, false, true));
  EXPECT_FLOAT_EQ(scan->getScanRange(1), 81.83F);
}

TEST(Carmen, NoReturnIsTheValueThatPilesUp) {
  std::string text;
  for (int k = 0; k < 10; ++k) text += flaser(k, 0, 180, rangesOf(20, 50) + rangesOf(159, 3) + " 49.2");
  const auto log = importText(text);
  const auto scan = log.all<CObservation2DRangeScan>().at(0);
  EXPECT_FLOAT_EQ(scan->maxRange, 50);
  EXPECT_FALSE(scan->getScanRangeValidity(0));
  EXPECT_TRUE(scan->getScanRangeValidity(179));
  EXPECT_TRUE(log.report.warnings.empty());
}

TEST(Carmen, ParametersAndOptionsSayTheMaximumRange) {
  const std::string lines =
      "PARAM robot_front_laser_max 30.0 host 0\n" + flaser(1, 0, 180, rangesOf(179, 2) + " 31");
  EXPECT_FALSE(importText(lines).all<CObservation2DRangeScan>().at(0)->getScanRangeValidity(179));
  ImportOptions options;
  options.max_range = 40;
  EXPECT_TRUE(importText(lines, options).all<CObservation2DRangeScan>().at(0)->getScanRangeValidity(179));
}

TEST(Carmen, UnknownMaximumRangeIsAWarning) {
  EXPECT_THAT(importText(flaser(1, 0)).report.warnings, ElementsAre(HasSubstr("--max-range")));
}

TEST(Carmen, BackwardStampsAreReplacedAndOrderIsKept) {
  const auto log = importText(flaser(10, 0) + flaser(11, 1) + flaser(9.5, 2) + flaser(13, 3));
  const auto scans = log.all<CObservation2DRangeScan>();
  ASSERT_EQ(scans.size(), 4u);
  EXPECT_NEAR(seconds(*scans[2]), 12, 1e-6);
  EXPECT_NEAR(log.all<CObservationOdometry>()[2]->odometry.x(), 2, 1e-9);
  EXPECT_THAT(log.report.warnings,
              Contains(AllOf(HasSubstr("1 of 4 ipc_timestamps do not increase"), HasSubstr("2.500 s"))));
}

TEST(Carmen, StampsOfTheLoggerOnRequestOrNeed) {
  ImportOptions options;
  options.stamps = CarmenStamps::kLogger;
  EXPECT_NEAR(seconds(*importText(flaser(110, 0), options).objects[0]), 10, 1e-6);
  std::string text;  // all ipc stamps are zero
  for (int k = 0; k < 5; ++k)
    text += "FLASER 180" + rangesOf(180, 2) + " 0 0 0 0 0 0 0 host " + std::to_string(k) + "\n";
  EXPECT_NEAR(seconds(*importText(text).objects.back()), 4, 1e-6);
  options.stamps = CarmenStamps::kIpc;
  EXPECT_LT(seconds(*importText(text, options).objects.back()), 1);
}

TEST(Carmen, LaserPoseFromParametersLinesOrOptions) {
  const std::string offset = "PARAM robot_frontlaser_offset -0.04 host 0\n";
  EXPECT_NEAR(importText(offset + flaser(1, 5)).all<CObservation2DRangeScan>()[0]->sensorPose.x(), -0.04,
              1e-6);
  // laser at (0.22, 0) on a robot that looks along y
  const std::string line = "FLASER 180" + rangesOf(180, 2) + " 1 2.22 1.570796 1 2 1.570796 1 host 1\n";
  EXPECT_NEAR(importText(line).all<CObservation2DRangeScan>()[0]->sensorPose.x(), 0.22, 1e-5);
  EXPECT_NEAR(importText(line).all<CObservationOdometry>()[0]->odometry.y(), 2, 1e-6);
  ImportOptions options;
  options.T_robot_sensor = mrpt::math::TPose2D(1, 2, 0.5 * kDegree);
  const auto scan = importText(offset + line, options).all<CObservation2DRangeScan>()[0];
  EXPECT_NEAR(scan->sensorPose.y(), 2, 1e-6);
  EXPECT_NEAR(scan->sensorPose.yaw(), 0, 1e-6);  // +0.5 by the option, −0.5 to the middle of the beams
}

TEST(Carmen, CorrectedPosesAreNoLaserOffset) {
  const std::string text = "FLASER 180" + rangesOf(180, 2) + " 1 0 0 0 0 0 1 h 1\n" + "FLASER 180" +
                           rangesOf(180, 2) + " 3 1 0.4 1 0 0 2 h 2\n";
  const auto log = importText(text);
  EXPECT_NEAR(log.all<CObservation2DRangeScan>()[1]->sensorPose.x(), 0, 1e-9);
  EXPECT_NEAR(log.all<CObservationOdometry>()[1]->odometry.x(), 1, 1e-9);  // odometry, not the correction
}

TEST(Carmen, RearLaserLooksBack) {
  std::string rear = flaser(1.5, 0);
  rear[0] = 'R';
  const auto scans = importText(flaser(1, 0) + rear).all<CObservation2DRangeScan>();
  EXPECT_EQ(scans[1]->sensorLabel, "LASER_2");
  EXPECT_NEAR(std::cos(angleOf(*scans[1], 90)), -1, 1e-9);
}

/** 5 beams 45° apart from −90°, laser 0.2 m ahead, maximum 10 m. */
std::string robotLaser(const std::string& remissions) {
  return "ROBOTLASER1 0 -1.570796 3.141593 0.785398 10.0 0.01 0 5 1 2 10 11 5 " + remissions +
         "1.2 0 0 1 0 0 0.5 0.1 0.3 0.2 0 7.5 host 3\n";
}

TEST(Carmen, NewScanSaysEverything) {
  for (const char* remissions : {"0 ", "5 1 2 3 4 5 ", ""}) {  // without: the first writers of ROBOTLASER
    const auto log = importText(robotLaser(remissions));
    ASSERT_FALSE(log.report.damaged()) << log.report.asText();
    const auto scan = log.all<CObservation2DRangeScan>().at(0);
    EXPECT_NEAR(angleOf(*scan, 0), -90 * kDegree, 1e-5);
    EXPECT_NEAR(angleOf(*scan, 4), 90 * kDegree, 1e-5);
    EXPECT_NEAR(scan->sensorPose.x(), 0.2, 1e-6);
    EXPECT_TRUE(scan->getScanRangeValidity(1));
    EXPECT_FALSE(scan->getScanRangeValidity(2));  // exactly the maximum
    EXPECT_FALSE(scan->getScanRangeValidity(3));
    EXPECT_NEAR(seconds(*scan), 7.5, 1e-6);
  }
}

TEST(Carmen, OfTwoLinesForOneScanTheFullerOneIsTaken) {
  const auto log = importText(
      robotLaser("0 ") + "RAWLASER1 0 -1.570796 3.141593 0.785398 10.0 0.01 0 5 1 2 10 11 5 0 7.4 h 3\n" +
      "ODOM 1 0 0 0 0 0 7.3 h 3\n" + flaser(7.5, 1));
  EXPECT_EQ(log.all<CObservation2DRangeScan>().size(), 1u);
  EXPECT_EQ(log.all<CObservationOdometry>().size(), 1u);
  EXPECT_THAT(log.report.notes, testing::Contains(HasSubstr("the RAWLASER lines are left out")));
}

TEST(Carmen, RawScansTakeTheOdometryLines) {
  const auto log = importText(
      "ODOM 1 2 0.5 0.1 0 0 7.3 h 3\nRAWLASER1 0 -1.570796 3.141593 0.785398 10.0 0.01 0 5 1 2 10 11 5 0 7.4 "
      "h 3\n");
  ASSERT_EQ(log.all<CObservationOdometry>().size(), 1u);
  EXPECT_NEAR(log.all<CObservationOdometry>()[0]->odometry.y(), 2, 1e-9);
  EXPECT_NEAR(seconds(*log.all<CObservationOdometry>()[0]), 7.3, 1e-6);
}

TEST(Carmen, DamagedLinesAreLeftOutAndNamed) {
  const std::string cut = flaser(3, 0).substr(0, 100);
  const auto log = importText("# comment\n" + flaser(1, 0) + "FLASER 180 1 2 x\n" + "STRANGE 1 2\n\n" +
                              flaser(2, 0) + cut);
  EXPECT_EQ(log.all<CObservation2DRangeScan>().size(), 2u);
  EXPECT_EQ(log.report.damaged_lines, 2u);
  ASSERT_EQ(log.report.damage.size(), 2u);
  EXPECT_THAT(log.report.damage[0], HasSubstr("a.log:3: 'x' for a range: expected a number"));
  EXPECT_THAT(log.report.damage[1], HasSubstr("a.log:7: the line ends before a range"));
  EXPECT_NEAR(seconds(*log.objects.back()), 2, 1e-6);
}

TEST(Carmen, RefusesWhatHoldsNoScan) {
  EXPECT_THAT(refusal("PARAM robot_frontlaser_offset 0\nODOM 0 0 0 0 0 0 1 h 1\n"),
              HasSubstr("holds no laser scan"));
  EXPECT_THAT(refusal("FLASER 0 0 0 0 0 0 0 1 h 1\n"), HasSubstr("holds no laser scan"));
}

TEST(Carmen, IsReadAsALogWithOdometry) {
  const TempFolder temp;
  std::string text;
  for (int k = 0; k < 20; ++k) text += flaser(1000 + 0.2 * k, 0.1 * k);
  importFile(temp.write("a.log", text), temp.file("a.rawlog"), {}, {});
  const LogReport report = checkLog(temp.file("a.rawlog"));
  EXPECT_FALSE(report.hasErrors()) << report.asText();
  EXPECT_EQ(report.frames, 20u);
  EXPECT_EQ(report.frames_with_odometry, 20u);
  EXPECT_NEAR(report.path_length_m, 1.9, 1e-6);
  EXPECT_EQ(report.backward_stamps, 0u);
}

}  // namespace
}  // namespace submap_slam
