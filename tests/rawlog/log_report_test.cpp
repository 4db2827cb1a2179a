#include <gmock/gmock.h>

#include <cmath>

#include "../support/temp_folder.h"
#include "log_builder.h"

namespace submap_slam {
namespace {

using testing::HasSubstr;
using testing::Not;

LogReport reportOf(const LogBuilder& log) {
  TempFolder temp;
  return checkLog(log.saveGz(temp.file("a.rawlog")));
}

TEST(LogReport, CountsPathGapsAndJumps) {
  LogBuilder log;  // steps of 3-4-5 m, of 0.5 m and of a half turn; the first is not measured by any before
  log.add(odometryAt(0, 0, 0, 0)).add(scanAt(0)).add(odometryAt(1, 3, 4, 0)).add(scanAt(1));
  log.add(odometryAt(8, 3, 4.5, 0)).add(scanAt(8)).add(odometryAt(9, 3, 4.5, 3)).add(scanAt(9));
  const auto report = reportOf(log);
  EXPECT_EQ(report.frames, 4u);
  EXPECT_NEAR(report.path_length_m, 5.5, 1e-9);
  EXPECT_NEAR(report.largest_step_m, 5.0, 1e-9);
  EXPECT_NEAR(report.largest_step_rad, 3.0, 1e-9);
  EXPECT_EQ(report.sparse_steps, 2u);
  EXPECT_EQ(report.odometry_jumps, 1u);
  EXPECT_NEAR(report.largest_gap_s, 7.0, 1e-6);
  EXPECT_NEAR(report.duration_s(), 9.0, 1e-6);
  EXPECT_EQ(report.bytes_read, report.file_bytes);
}

TEST(LogReport, TellsBursts) {
  LogBuilder log;
  for (int k = 0; k < 10; ++k) log.add(scanAt(k)).add(scanAt(k + 0.002));
  const auto report = reportOf(log);
  EXPECT_EQ(report.scanners.at("LASER").burst_steps, 10u);
  EXPECT_THAT(report.asText(), HasSubstr("in bursts"));
}

TEST(LogReport, DescribesScanners) {
  LogBuilder log;
  auto other = scanAt(2);
  other.maxRange = 30;
  log.add(scanAt(0)).add(scanAt(1)).add(other);
  const auto report = reportOf(log);
  const auto& scanner = report.scanners.at("LASER");
  EXPECT_EQ(scanner.scans, 3u);
  EXPECT_EQ(scanner.beams, 4u);
  EXPECT_NEAR(scanner.aperture, 1.5, 1e-6);
  EXPECT_NEAR(scanner.max_range, 20, 1e-6);
  EXPECT_EQ(scanner.geometry_changes, 1u);
}

TEST(LogReport, GoodLogHasNoFindings) {
  LogBuilder log;
  for (int k = 0; k < 10; ++k) log.add(odometryAt(k, 0.1 * k, 0, 0)).add(scanAt(k));
  const auto report = reportOf(log);
  EXPECT_TRUE(report.findings.empty()) << report.asText();
  EXPECT_FALSE(report.hasErrors());
}

TEST(LogReport, MostSevereFindingComesFirst) {
  LogReport report;
  report.frames = 2;
  report.frames_with_odometry = 2;
  report.equal_stamps = 1;
  report.backward_stamps = 1;
  report.damage = LogDamage{};
  report.findings = assess(report);
  ASSERT_EQ(report.findings.size(), 3u);
  EXPECT_EQ(report.findings[0].severity, Severity::kError);
  EXPECT_EQ(report.findings[1].severity, Severity::kWarning);
  EXPECT_EQ(report.findings[2].severity, Severity::kInfo);
}

TEST(LogReport, AFastVehicleDoesNotJump) {
  LogBuilder fast, resets;
  double x = 0;
  for (int k = 0; k < 100; ++k) {  // speeds up and down between 1 and 9 m/s, five scans a second
    x += 0.2 * (5 - 4 * std::cos(0.06 * k));
    fast.add(odometryAt(0.2 * k, x, 0, 0)).add(scanAt(0.2 * k));
    resets.add(odometryAt(0.2 * k, k < 50 ? x : x - 20, 0, 0)).add(scanAt(0.2 * k));
  }
  EXPECT_EQ(reportOf(fast).odometry_jumps, 0u);
  EXPECT_TRUE(reportOf(fast).findings.empty()) << "steps of 1.8 m five times a second: " << x << " m";
  EXPECT_GE(reportOf(resets).odometry_jumps, 1u);
  EXPECT_THAT(reportOf(resets).asText(), HasSubstr("warning: Odometry jumps at"));
  EXPECT_THAT(reportOf(resets).asText(), Not(HasSubstr("sparse")));
}

TEST(LogReport, ALogMayBeginAtSpeed) {
  LogBuilder log;
  for (int k = 0; k < 20; ++k) log.add(odometryAt(0.2 * k, 1.8 * k, 0, 0)).add(scanAt(0.2 * k));
  EXPECT_TRUE(reportOf(log).findings.empty()) << reportOf(log).asText();
}

TEST(LogReport, SaysWhatTheLackOfOdometryMeansForEachMap) {
  LogReport report;
  report.frames = 2;
  const auto text = [&] {
    report.findings = assess(report);
    return report.asText();
  };
  report.landmark_sensors["TREES"].observations = 2;
  EXPECT_THAT(text(), HasSubstr("taken to go on as before"));
  EXPECT_THAT(text(), Not(HasSubstr("scan matching")));
  report.scanners["LASER"].scans = 2;
  EXPECT_THAT(text(), HasSubstr("scan matching alone"));
  EXPECT_THAT(text(), HasSubstr("taken to go on as before"));
  report.landmark_sensors.clear();
  EXPECT_THAT(text(), Not(HasSubstr("taken to go on as before")));
}

TEST(LogReport, SaysThatAVehicleLacksItsVelocities) {
  LogBuilder log;
  log.add(scanAt(0)).add(scanAt(1)).add(scanAt(1));
  TempFolder temp;
  ReaderParams params;
  params.vehicle.model = "ackermann";
  const LogReport report = checkLog(log.saveGz(temp.file("a.rawlog")), params);
  EXPECT_THAT(report.asText(), HasSubstr("warning: [vehicle] model = ackermann needs velocities"));
  EXPECT_EQ(report.findings.back().severity, Severity::kInfo) << "equal stamps, behind all warnings";
}

TEST(LogReport, SparseLogIsNotBlamedForJumps) {
  LogBuilder sparse, reset, sparse_reset;
  for (int k = 0; k < 20; ++k) {
    sparse.add(odometryAt(k, 2.0 * k, 0, 0)).add(scanAt(k));
    sparse_reset.add(odometryAt(k, k < 10 ? 2.0 * k : 2.0 * k - 20, 0, 0)).add(scanAt(k));
    reset.add(odometryAt(k, k < 10 ? 10 : 0, 0, 0)).add(scanAt(k));
  }
  EXPECT_THAT(reportOf(sparse).asText(), HasSubstr("info: The log is sparse: 19 of 20 steps"));
  EXPECT_THAT(reportOf(sparse).asText(), Not(HasSubstr("jumps")));
  EXPECT_THAT(reportOf(sparse_reset).asText(), HasSubstr("warning: Odometry jumps at 1 frames"));
  EXPECT_THAT(reportOf(sparse_reset).asText(), HasSubstr("sparse"));
  EXPECT_THAT(reportOf(reset).asText(), HasSubstr("Odometry jumps"));
  EXPECT_THAT(reportOf(reset).asText(), Not(HasSubstr("sparse")));
}

}  // namespace
}  // namespace submap_slam
