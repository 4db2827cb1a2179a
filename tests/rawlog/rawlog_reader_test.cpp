#include <gmock/gmock.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CRawlog.h>
#include <submap_slam/core/errors.h>

#include <cmath>
#include <limits>

#include "../support/temp_folder.h"
#include "log_builder.h"

namespace submap_slam {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::string errorOf(const std::string& file, const ReaderParams& params = {}) {
  try {
    framesOf(file, params);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

std::vector<uint64_t> indicesOf(const std::string& file, const std::string& from, const std::string& to) {
  ReaderParams params;
  params.from = from;
  params.to = to;
  std::vector<uint64_t> indices;
  for (const auto& frame : framesOf(file, params)) indices.push_back(frame.index);
  return indices;
}

TEST(RawlogReader, PlainAndGzipGiveTheSameFrames) {
  TempFolder temp;
  LogBuilder log;
  for (int k = 0; k < 300; ++k) log.add(odometryAt(k, k, 0, 0)).add(scanAt(k));
  const auto plain = framesOf(log.savePlain(temp.file("a.rawlog")));
  const auto packed = framesOf(log.saveGz(temp.file("b.rawlog")));
  ASSERT_EQ(plain.size(), 300u);
  ASSERT_EQ(packed.size(), 300u);
  for (std::size_t k = 0; k < 300; ++k) {
    EXPECT_EQ(plain[k].index, k);
    EXPECT_EQ(plain[k].stamp, at(static_cast<double>(k)));
    EXPECT_EQ(packed[k].stamp, plain[k].stamp);
    EXPECT_EQ(plain[k].odometry->x, static_cast<double>(k));
    EXPECT_EQ(packed[k].odometry->x, plain[k].odometry->x);
  }
}

TEST(RawlogReader, BothFormsOfALogGiveTheSameFrames) {
  TempFolder temp;
  LogBuilder observations, actions;
  mrpt::poses::CPose2D pose;
  for (int k = 0; k < 20; ++k) {
    const mrpt::poses::CPose2D step(0.3, 0.01 * k, 0.2);
    if (k > 0) {
      pose = pose + step;
      actions.add(movement(step.x(), step.y(), step.phi()));
    }
    actions.addFrame({scanAt(k)});
    observations.add(odometryAt(k, pose.x(), pose.y(), pose.phi())).add(scanAt(k));
  }
  const auto a = framesOf(observations.saveGz(temp.file("observations.rawlog")));
  const auto b = framesOf(actions.saveGz(temp.file("actions.rawlog")));
  ASSERT_EQ(a.size(), 20u);
  ASSERT_EQ(b.size(), 20u);
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].stamp, b[k].stamp);
    EXPECT_NEAR(a[k].odometry->x, b[k].odometry->x, 1e-12);
    EXPECT_NEAR(a[k].odometry->y, b[k].odometry->y, 1e-12);
    EXPECT_NEAR(std::remainder(a[k].odometry->phi - b[k].odometry->phi, 2 * M_PI), 0, 1e-12);
  }
}

TEST(RawlogReader, KeepsSensorPoseDirectionAndRanges) {
  TempFolder temp;
  auto scan = scanAt(0);
  scan.rightToLeft = false;
  scan.sensorPose = mrpt::poses::CPose3D(0.3, -0.1, 0.4, 0.7, 0, 0);
  LogBuilder log;
  const auto frames = framesOf(log.add(scan).savePlain(temp.file("a.rawlog")));
  ASSERT_EQ(frames.size(), 1u);
  const auto& read = *frames[0].scans.at(0);
  EXPECT_FALSE(read.rightToLeft);
  EXPECT_EQ(read.sensorLabel, "LASER");
  EXPECT_NEAR(read.sensorPose.x(), 0.3, 1e-12);
  EXPECT_NEAR(read.sensorPose.yaw(), 0.7, 1e-12);
  ASSERT_EQ(read.getScanSize(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(read.getScanRange(i), static_cast<float>(i + 1));
    EXPECT_TRUE(read.getScanRangeValidity(i));
  }
  EXPECT_FALSE(frames[0].odometry);
}

TEST(RawlogReader, InvalidatesUnusableRanges) {
  TempFolder temp;
  auto scan = scanAt(0);
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<float> ranges = {std::nanf(""), inf,   -inf,  -1.0f, 0.0f, 0.04f,
                                     0.05f,         19.9f, 20.0f, 81.0f, 3.0f};
  scan.resizeScanAndAssign(ranges.size(), 0.0f, true);
  for (std::size_t i = 0; i < ranges.size(); ++i) scan.setScanRange(i, ranges[i]);
  scan.setScanRangeValidity(10, false);
  LogBuilder log;
  RawlogReader reader(log.add(scan).savePlain(temp.file("a.rawlog")));
  const auto frames = allFrames(reader);
  const auto& read = *frames.at(0).scans.at(0);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    EXPECT_EQ(read.getScanRangeValidity(i), i == 6 || i == 7) << i;
    EXPECT_EQ(read.getScanRange(i), i < 4 ? 0.0f : ranges[i]) << i;
  }
  const auto& counts = reader.report().scanners.at("LASER");
  EXPECT_EQ(counts.beams_total, 11u);
  EXPECT_EQ(counts.beams_broken, 4u);
  EXPECT_EQ(counts.beams_invalid, 3u);
  EXPECT_EQ(counts.beams_no_return, 2u);
}

TEST(RawlogReader, MergesScannersWithTheSameStamp) {
  TempFolder temp;
  LogBuilder log;
  log.add(scanAt(0, "FRONT")).add(odometryAt(0, 1, 0, 0)).add(scanAt(0, "REAR"));
  log.add(scanAt(1, "FRONT")).add(scanAt(1.01, "REAR"));
  const auto frames = framesOf(log.saveGz(temp.file("a.rawlog")));
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[0].scans.size(), 2u);
  EXPECT_EQ(frames[1].scans.size(), 1u);
  EXPECT_EQ(frames[2].scans.at(0)->sensorLabel, "REAR");
}

TEST(RawlogReader, EqualStampsOfOneScannerAreSeparateFramesWithTheirOwnOdometry) {
  TempFolder temp;
  LogBuilder log;
  for (int k = 0; k < 5; ++k) log.add(odometryAt(0, k, 0, 0)).add(scanAt(0));
  RawlogReader reader(log.saveGz(temp.file("a.rawlog")));
  const auto frames = allFrames(reader);
  ASSERT_EQ(frames.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(frames[k].odometry->x, static_cast<double>(k));
  EXPECT_EQ(reader.report().equal_stamps, 4u);
}

TEST(RawlogReader, SensoryFramesWithTheSameStampAreNotMerged) {
  TempFolder temp;
  LogBuilder log;
  log.addFrame({scanAt(0, "FRONT")}).add(movement(1, 0, 0)).addFrame({scanAt(0, "REAR")});
  const auto frames = framesOf(log.saveGz(temp.file("a.rawlog")));
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].odometry->x, 0.0);
  EXPECT_EQ(frames[1].odometry->x, 1.0);
}

TEST(RawlogReader, ChoosesSensorLabels) {
  TempFolder temp;
  LogBuilder log;
  for (int k = 0; k < 3; ++k) log.add(scanAt(k, "FRONT")).add(scanAt(k, "REAR")).add(scanAt(k, "TOP"));
  const auto file = log.saveGz(temp.file("a.rawlog"));
  ReaderParams params;
  params.sensor_labels = " REAR ,FRONT";
  for (const auto& frame : framesOf(file, params)) EXPECT_EQ(frame.scans.size(), 2u);
  params.sensor_labels = "NOSE";
  EXPECT_THAT(errorOf(file, params), AllOf(HasSubstr("NOSE"), HasSubstr("'FRONT', 'REAR', 'TOP'")));
}

TEST(RawlogReader, SkipsAndCountsWhatItCannotUse) {
  TempFolder temp;
  auto tilted = scanAt(1), rolled = scanAt(1.1), empty = scanAt(1.2), flat = scanAt(1.3), shaky = scanAt(1.4);
  tilted.sensorPose = mrpt::poses::CPose3D(0, 0, 0, 0, mrpt::DEG2RAD(6.0), 0);
  rolled.sensorPose = mrpt::poses::CPose3D(0, 0, 0, 0, 0, M_PI / 2);
  empty.resizeScan(0);
  flat.aperture = 0;
  shaky.sensorPose = mrpt::poses::CPose3D(0, 0, 0, 0, mrpt::DEG2RAD(4.0), 0);
  LogBuilder log;
  log.add(tilted).add(rolled).add(empty).add(flat).add(shaky);
  log.add(mrpt::obs::CObservationComment()).add(mrpt::obs::CRawlog());
  RawlogReader reader(log.saveGz(temp.file("a.rawlog")));
  EXPECT_EQ(allFrames(reader).size(), 1u);
  const auto& report = reader.report();
  EXPECT_EQ(report.skipped_scans_tilted, 2u);
  EXPECT_EQ(report.skipped_scans_empty, 1u);
  EXPECT_EQ(report.skipped_scans_bad, 1u);
  EXPECT_EQ(report.nested_logs, 1u);
  EXPECT_EQ(report.entries, 7u);
  EXPECT_EQ(report.classes.at("mrpt::obs::CObservation2DRangeScan"), 5u);
  EXPECT_EQ(report.classes.at("mrpt::obs::CObservationComment"), 1u);
}

TEST(RawlogReader, TakesScannersMountedUpsideDown) {
  TempFolder temp;
  LogBuilder log;
  const auto add = [&](double pitch_deg, double roll_deg) {
    auto scan = scanAt(static_cast<double>(log.ends().size()));
    scan.sensorPose =
        mrpt::poses::CPose3D(0.1, 0, 0.3, 0.5, mrpt::DEG2RAD(pitch_deg), mrpt::DEG2RAD(roll_deg));
    log.add(scan);
  };
  for (const double roll : {180.0, -180.0, 176.0, -176.0}) add(0, roll);
  for (const double roll : {174.0, -174.0, 90.0}) add(0, roll);
  add(6, 180);
  RawlogReader reader(log.savePlain(temp.file("a.rawlog")));
  const auto frames = allFrames(reader);
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_EQ(reader.report().skipped_scans_tilted, 4u);
  const auto pose = frames[0].scans.at(0)->sensorPose;
  EXPECT_NEAR(pose.yaw(), 0.5, 1e-9);
  EXPECT_NEAR(std::abs(pose.roll()), M_PI, 1e-9);
}

TEST(RawlogReader, SaysWhyNoScanIsUsable) {
  TempFolder temp;
  auto tilted = scanAt(0), empty = scanAt(2), flat = scanAt(3);
  tilted.sensorPose = mrpt::poses::CPose3D(0, 0, 0, 0, 0.3, 0);
  empty.resizeScan(0);
  flat.aperture = 0;
  LogBuilder log;
  log.add(tilted).add(tilted).add(empty).add(flat);
  EXPECT_THAT(errorOf(log.savePlain(temp.file("a.rawlog"))),
              AllOf(HasSubstr("2 tilted"), HasSubstr("1 with a senseless"), HasSubstr("1 without beams")));
}

TEST(RawlogReader, FromAndToByEntry) {
  TempFolder temp;
  LogBuilder log;
  for (int k = 0; k < 6; ++k)
    log.add(odometryAt(10 + k, k, 0, 0)).add(scanAt(10 + k));  // scans are entries 1, 3, …
  const auto file = log.saveGz(temp.file("a.rawlog"));
  EXPECT_THAT(indicesOf(file, "3", "7"), ElementsAre(1, 2, 3));
  EXPECT_THAT(indicesOf(file, "4", "6"), ElementsAre(2));
  EXPECT_THAT(indicesOf(file, "", "1"), ElementsAre(0));
  EXPECT_THAT(indicesOf(file, "11", ""), ElementsAre(5));
}

TEST(RawlogReader, FromAndToBySeconds) {
  TempFolder temp;
  LogBuilder log;
  for (int k = 0; k < 6; ++k) log.add(odometryAt(10 + k, k, 0, 0)).add(scanAt(10 + k));
  const auto file = log.saveGz(temp.file("a.rawlog"));
  EXPECT_THAT(indicesOf(file, "1s", "3s"), ElementsAre(1, 2, 3));
  EXPECT_THAT(indicesOf(file, "0.5s", "1.5s"), ElementsAre(1));
  EXPECT_THAT(indicesOf(file, "4", "3.5s"), ElementsAre(2, 3));
}

/** Frames stamped 0, 1, … 19 s, but `count` of them a year later. */
LogBuilder logWithWrongStamps(int first_wrong, int count, bool with_odometry) {
  constexpr double kYear_s = 365 * 86400.0;
  LogBuilder log;
  for (int k = 0; k < 20; ++k) {
    if (with_odometry) log.add(odometryAt(k, k, 0, 0));
    log.add(scanAt(k >= first_wrong && k < first_wrong + count ? k + kYear_s : k));
  }
  return log;
}

TEST(RawlogReader, AFewWrongStampsDoNotEndATimeSpan) {
  TempFolder temp;
  ReaderParams params;
  params.to = "15s";
  for (const bool with_odometry : {true, false}) {
    const auto file = logWithWrongStamps(4, 2, with_odometry).savePlain(temp.file("a.rawlog"));
    RawlogReader reader(file, params);
    const auto frames = allFrames(reader);
    ASSERT_EQ(frames.size(), 14u);
    EXPECT_EQ(frames[3].stamp, at(3));
    EXPECT_EQ(frames[4].stamp, at(6));
    for (std::size_t k = 0; k < frames.size(); ++k) EXPECT_EQ(frames[k].index, k);
    EXPECT_EQ(reader.report().skipped_frames_stamp, 2u);
    EXPECT_THAT(reader.report().asText(), HasSubstr("2 frames were skipped"));
  }
}

TEST(RawlogReader, ManyFramesInARowBehindToAreTheEnd) {
  TempFolder temp;
  ReaderParams params;
  params.to = "15s";
  RawlogReader nine(logWithWrongStamps(4, 9, false).savePlain(temp.file("nine.rawlog")), params);
  EXPECT_EQ(allFrames(nine).size(), 7u);
  RawlogReader ten(logWithWrongStamps(4, 10, false).savePlain(temp.file("ten.rawlog")), params);
  EXPECT_EQ(allFrames(ten).size(), 4u);
  EXPECT_EQ(ten.report().skipped_frames_stamp, 0u) << "they are taken for the rest of the log";
}

TEST(RawlogReader, NothingBetweenFromAndToIsAnError) {
  TempFolder temp;
  LogBuilder log;
  const auto file = log.add(scanAt(0)).saveGz(temp.file("a.rawlog"));
  ReaderParams params;
  params.from = "100s";
  EXPECT_THAT(errorOf(file, params), AllOf(HasSubstr(file), HasSubstr("100s")));
}

TEST(RawlogReader, DamageBehindToDoesNotMatter) {
  TempFolder temp;
  LogBuilder log;
  for (int k = 0; k < 6; ++k) log.add(scanAt(k));
  const auto file = temp.write("a.rawlog", log.bytes() + "rubbish");
  EXPECT_THROW(framesOf(file), InputError);
  EXPECT_THAT(indicesOf(file, "", "3"), ElementsAre(0, 1, 2, 3)) << "frames are delayed for odometry to come";
  EXPECT_THAT(indicesOf(file, "", "3s"), ElementsAre(0, 1, 2, 3));
}

TEST(RawlogReader, RefusesBadPlaces) {
  TempFolder temp;
  LogBuilder log;
  const auto file = log.add(scanAt(0)).saveGz(temp.file("a.rawlog"));
  for (const std::string bad : {"x", "-1", "1.5", "-2s", "s", "3 s", "nans", "1e999s", "5m"}) {
    ReaderParams params;
    params.from = bad;
    EXPECT_THROW(RawlogReader(file, params), ConfigError) << bad;
  }
}

TEST(RawlogReader, KeepsTheOrderOfTheFileWhereStampsRunBackwards) {
  TempFolder temp;
  LogBuilder log;
  const std::vector<double> stamps = {5, 6, 4, 4.5, 7};
  for (std::size_t k = 0; k < stamps.size(); ++k)
    log.add(odometryAt(stamps[k], static_cast<double>(k), 0, 0)).add(scanAt(stamps[k]));
  RawlogReader reader(log.saveGz(temp.file("a.rawlog")));
  const auto frames = allFrames(reader);
  ASSERT_EQ(frames.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(frames[k].stamp, at(stamps[k]));
    EXPECT_EQ(frames[k].odometry->x, static_cast<double>(k));
  }
  EXPECT_EQ(reader.report().backward_stamps, 1u);
  EXPECT_NEAR(reader.report().duration_s(), 3.0, 1e-6);
}

TEST(RawlogReader, LogWithoutOdometryGivesFramesWithoutIt) {
  TempFolder temp;
  LogBuilder log;
  for (int k = 0; k < 600; ++k) log.add(scanAt(k));
  RawlogReader reader(log.saveGz(temp.file("a.rawlog")));
  const auto frames = allFrames(reader);
  ASSERT_EQ(frames.size(), 600u);
  for (const auto& frame : frames) EXPECT_FALSE(frame.odometry);
}

TEST(RawlogReader, OtherFilesAreRefusedInOneClearLine) {
  TempFolder temp;
  EXPECT_THAT(errorOf(temp.file("missing")), HasSubstr("no such file"));
  EXPECT_THAT(errorOf(temp.file("")), HasSubstr("folder"));
  EXPECT_THAT(errorOf(temp.write("empty", "")), HasSubstr("empty"));
  EXPECT_THAT(errorOf(temp.write("text", "Hello, this is a text.\n")), HasSubstr("no rawlog"));
  EXPECT_THAT(errorOf(temp.write("png", "\x89PNG\r\n\x1a\n and so on")), HasSubstr("no rawlog"));
  EXPECT_THAT(errorOf(temp.write("short", "\x1f")), HasSubstr("ends in the middle"));
  LogBuilder comment;
  const auto file = comment.add(mrpt::obs::CObservationComment()).saveGz(temp.file("comment"));
  EXPECT_THAT(errorOf(file), AllOf(HasSubstr("no usable 2D laser scan"), HasSubstr("CObservationComment")));
  for (const auto name : {"missing", "empty", "text", "png", "comment"})
    EXPECT_EQ(errorOf(temp.file(name)).find('\n'), std::string::npos) << name;
}

TEST(RawlogReader, ParametersAreDescribed) {
  ReaderParams params;
  ParameterTable table;
  describe(table, params);
  table.set("reader.sensor_labels=FRONT");
  table.set("reader.min_range=0.2");
  table.set("reader.from=60s");
  table.set("reader.to=100");
  EXPECT_EQ(params.sensor_labels, "FRONT");
  EXPECT_EQ(params.min_range, 0.2);
  EXPECT_EQ(params.from, "60s");
  EXPECT_EQ(params.to, "100");
  EXPECT_THROW(table.set("reader.min_range=-1"), ConfigError);
}

TEST(RawlogReader, RealLogOfTheLibrary) {
  const std::string file = "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "MRPT's data sets are not installed";
  const auto report = checkLog(file);
  EXPECT_FALSE(report.damage);
  EXPECT_EQ(report.frames, 225u);
  EXPECT_EQ(report.entries, 449u);
  EXPECT_EQ(report.odometry_readings, 224u);
  EXPECT_EQ(report.frames_with_odometry, 225u);
  EXPECT_EQ(report.scanners.at("").beams, 361u);
  EXPECT_NEAR(report.scanners.at("").sensor_pose.x, 0.78, 1e-6);
}

}  // namespace
}  // namespace submap_slam
