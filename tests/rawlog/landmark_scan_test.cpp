#include <gmock/gmock.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <submap_slam/core/errors.h>

#include <cmath>
#include <limits>

#include "../support/temp_folder.h"
#include "log_builder.h"

namespace submap_slam {
namespace {

using mrpt::obs::CObservationBearingRange;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

struct Sensed {
  double range, yaw, pitch = 0;
  int id = -1;
};

CObservationBearingRange treesAt(double seconds, const std::vector<Sensed>& trees,
                                 const std::string& label = "TREES") {
  CObservationBearingRange observation;
  observation.timestamp = at(seconds);
  observation.sensorLabel = label;
  observation.maxSensorDistance = 75;
  observation.sensor_std_range = 0.5f;
  observation.sensor_std_yaw = 0.25f;
  for (const Sensed& tree : trees) {
    CObservationBearingRange::TMeasurement measurement;
    measurement.range = static_cast<float>(tree.range);
    measurement.yaw = static_cast<float>(tree.yaw);
    measurement.pitch = static_cast<float>(tree.pitch);
    measurement.landmarkID = tree.id;
    observation.sensedData.push_back(measurement);
  }
  return observation;
}

/** Frames and report of a log. */
struct ReadLog {
  std::vector<Frame> frames;
  LogReport report;

  explicit ReadLog(const LogBuilder& log, const ReaderParams& params = {}) {
    TempFolder temp;
    RawlogReader reader(log.saveGz(temp.file("a.rawlog")), params);
    frames = allFrames(reader);
    report = reader.report();
  }
};

std::string errorOf(const LogBuilder& log, const ReaderParams& params) {
  try {
    ReadLog read(log, params);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(LandmarkScan, KeepsWhatTheLogSays) {
  auto trees = treesAt(1, {{4, 0.5}, {5, -0.5, 0, 7}});
  trees.setSensorPose(mrpt::poses::CPose3D(3.78, 0.5, 1.0, 0.25, 0, 0));
  const ReadLog log(LogBuilder().add(odometryAt(0, 0, 0, 0)).add(trees).add(odometryAt(2, 4, 0, 0)));
  ASSERT_EQ(log.frames.size(), 1u);
  const Frame& frame = log.frames[0];
  EXPECT_EQ(frame.stamp, at(1));
  EXPECT_NEAR(frame.odometry->x, 2, 1e-12);
  EXPECT_TRUE(frame.scans.empty());
  ASSERT_EQ(frame.landmark_scans.size(), 1u);
  const LandmarkScan& scan = frame.landmark_scans[0];
  EXPECT_EQ(scan.sensor_label, "TREES");
  EXPECT_NEAR(scan.T_robot_sensor.x, 3.78, 1e-12);
  EXPECT_NEAR(scan.T_robot_sensor.y, 0.5, 1e-12);
  EXPECT_NEAR(scan.T_robot_sensor.phi, 0.25, 1e-12);
  EXPECT_EQ(scan.max_range, 75);
  EXPECT_EQ(scan.sigma_range, 0.5);
  EXPECT_EQ(scan.sigma_bearing, 0.25);
  ASSERT_EQ(scan.measurements.size(), 2u);
  EXPECT_NEAR(scan.measurements[0].range, 4, 1e-12);
  EXPECT_NEAR(scan.measurements[0].bearing, 0.5, 1e-12);
  EXPECT_FALSE(scan.measurements[0].id);
  EXPECT_NEAR(scan.measurements[1].bearing, -0.5, 1e-12);
  EXPECT_EQ(scan.measurements[1].id, 7u);
}

TEST(LandmarkScan, SameStampIsOneFrameInBothForms) {
  mrpt::obs::CSensoryFrame sensory_frame;
  sensory_frame.insert(mrpt::obs::CObservation2DRangeScan::Create(scanAt(0)));
  sensory_frame.insert(CObservationBearingRange::Create(treesAt(0, {{4, 0}})));
  const ReadLog observations(LogBuilder().add(scanAt(0)).add(treesAt(0, {{4, 0}})).add(treesAt(1, {})));
  const ReadLog actions(
      LogBuilder().add(sensory_frame).add(movement(1, 0, 0)).add(mrpt::obs::CSensoryFrame(sensory_frame)));
  for (const ReadLog* log : {&observations, &actions}) {
    ASSERT_EQ(log->frames.size(), 2u);
    EXPECT_EQ(log->frames[0].scans.size(), 1u);
    EXPECT_EQ(log->frames[0].landmark_scans.size(), 1u);
    EXPECT_EQ(log->frames[1].landmark_scans.size(), 1u);
  }
  EXPECT_TRUE(observations.frames[1].scans.empty());
  EXPECT_EQ(actions.frames[1].odometry->x, 1);
}

TEST(LandmarkScan, TwoObservationsOfOneSensorAreTwoFrames) {
  const ReadLog log(
      LogBuilder().add(treesAt(0, {{4, 0}})).add(treesAt(0, {{5, 0}})).add(treesAt(0, {{6, 0}}, "LEFT")));
  ASSERT_EQ(log.frames.size(), 2u);
  EXPECT_EQ(log.frames[1].landmark_scans.size(), 2u);
}

TEST(LandmarkScan, BrokenMeasurementsAreLeftOutAndCounted) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const ReadLog log(LogBuilder()
                        .add(treesAt(0, {{nan, 0}, {4, nan}, {4, 0, nan}, {inf, 0}, {-4, 0}, {0, 0}}))
                        .add(treesAt(1, {{0.01, 0}, {4, 0}})));
  ASSERT_EQ(log.frames.size(), 2u);  // that nothing was seen is knowledge too
  EXPECT_TRUE(log.frames[0].landmark_scans[0].measurements.empty());
  EXPECT_EQ(log.frames[1].landmark_scans[0].measurements.size(), 1u);
  const auto& counts = log.report.landmark_sensors.at("TREES");
  EXPECT_EQ(counts.broken, 6u);
  EXPECT_EQ(counts.near, 1u);
  EXPECT_EQ(counts.measurements, 1u);
  EXPECT_EQ(counts.observations, 2u);
  EXPECT_EQ(counts.empty, 1u);
  EXPECT_THAT(log.report.asText(), HasSubstr("6 measurements are NaN"));
}

TEST(LandmarkScan, IdsAreCounted) {
  const ReadLog log(
      LogBuilder().add(treesAt(0, {{4, 0, 0, 3}, {5, 0, 0, 4}, {6, 0}})).add(treesAt(1, {{4, 0, 0, 3}})));
  const auto& counts = log.report.landmark_sensors.at("TREES");
  EXPECT_EQ(counts.with_id, 3u);
  EXPECT_THAT(counts.ids, ElementsAre(3u, 4u));
  EXPECT_THAT(log.report.asText(), HasSubstr("the others have none"));
}

TEST(LandmarkScan, AnIdTwiceInOneObservationIsDamage) {
  TempFolder temp;
  LogBuilder log;
  log.add(treesAt(0, {{4, 0, 0, 1}})).add(treesAt(1, {{4, 0, 0, 0x1234567}, {5, 0, 0, 0x1234568}}));
  std::string bytes = log.bytes();  // MRPT would not write it
  bytes.at(bytes.find("\x68\x45\x23\x01")) = '\x67';
  const LogReport report = checkLog(temp.write("a.rawlog", bytes));
  EXPECT_EQ(report.frames, 1u);
  ASSERT_TRUE(report.damage);
  EXPECT_THAT(report.damage->text,
              AllOf(HasSubstr("entry 1"), HasSubstr("because it has the landmark id 19088743 twice")));
}

TEST(LandmarkScan, AbsurdCountsAreRefusedBeforeMemoryIsAllocated) {
  TempFolder temp;
  auto own = treesAt(0, {{4, 0, 0, 2}});
  own.validCovariances = true;
  own.sensedData[0].covariance.setIdentity();
  for (const auto& observation : {treesAt(0, {{4, 0, 0, 2}}), own}) {
    const auto bytes = LogBuilder().add(observation).bytes();
    const auto label = bytes.find(std::string("\x05\0\0\0TREES", 9));
    const auto landmarks = bytes.find(std::string("\x01\0\0\0\0\0\x80\x40", 8));  // 1, then 4 m
    ASSERT_NE(label, std::string::npos);
    ASSERT_NE(landmarks, std::string::npos);
    for (const auto at : {label, landmarks}) {
      auto absurd = bytes;
      absurd[at + 3] = '\x7f';
      EXPECT_THAT(checkLog(temp.write("a.rawlog", absurd)).damage.value().text, HasSubstr("makes no sense"));
    }
  }
}

TEST(LandmarkScan, ProjectsPitchAndTiltedSensors) {
  // 60° below the horizon: half of the range is horizontal
  const ReadLog pitched(LogBuilder().add(treesAt(0, {{4, 0.3, M_PI / 3}})));
  const auto& a = pitched.frames[0].landmark_scans[0].measurements[0];
  EXPECT_NEAR(a.range, 2, 1e-6);
  EXPECT_NEAR(a.bearing, 0.3, 1e-6);

  auto upside_down = treesAt(0, {{4, 0.3}});
  upside_down.setSensorPose(mrpt::poses::CPose3D(0, 0, 1, 0.5, 0, M_PI));
  const ReadLog mirrored(LogBuilder().add(upside_down));
  EXPECT_NEAR(mirrored.frames[0].landmark_scans[0].measurements[0].bearing, -0.3, 1e-6);

  // a sensor that looks down by 60° sees a landmark 60° above its axis straight ahead
  auto tilted = treesAt(0, {{4, 0, -M_PI / 3}});
  tilted.setSensorPose(mrpt::poses::CPose3D(0, 0, 1, 0, M_PI / 3, 0));
  const ReadLog level(LogBuilder().add(tilted));
  EXPECT_NEAR(level.frames[0].landmark_scans[0].measurements[0].range, 4, 1e-6);
}

TEST(LandmarkScan, OwnCovariancesGiveTheirRootMeanSquare) {
  auto trees = treesAt(0, {{4, 0}, {5, 0}});
  trees.validCovariances = true;
  for (int i = 0; i < 2; ++i) {
    auto& covariance = trees.sensedData[static_cast<std::size_t>(i)].covariance;
    covariance.setZero();
    covariance(0, 0) = i == 0 ? 1 : 7;
    covariance(1, 1) = i == 0 ? 0.01 : 0.07;
  }
  const ReadLog log(LogBuilder().add(trees));
  EXPECT_NEAR(log.frames[0].landmark_scans[0].sigma_range, 2, 1e-12);
  EXPECT_NEAR(log.frames[0].landmark_scans[0].sigma_bearing, 0.2, 1e-12);
}

TEST(LandmarkScan, ObservationsWithoutASenseOfPlaceAreLeftOut) {
  auto nowhere = treesAt(0, {{4, 0}});
  nowhere.setSensorPose(mrpt::poses::CPose3D(std::numeric_limits<double>::quiet_NaN(), 0, 0, 0, 0, 0));
  EXPECT_THAT(
      errorOf(LogBuilder().add(nowhere), {}),
      AllOf(HasSubstr("landmark observations: 1 with a senseless sensor pose"), HasSubstr("no usable")));
  EXPECT_EQ(ReadLog(LogBuilder().add(nowhere).add(treesAt(1, {}))).report.skipped_landmarks_bad, 1u);
}

TEST(LandmarkScan, LabelsChooseSensors) {
  ReaderParams params;
  params.landmark_labels = "LEFT";
  const auto builder =
      LogBuilder().add(scanAt(0)).add(treesAt(0, {{4, 0}})).add(treesAt(0, {{5, 0}, {6, 0}}, "LEFT"));
  const ReadLog log(builder, params);
  ASSERT_EQ(log.frames.size(), 1u);
  EXPECT_EQ(log.frames[0].scans.size(), 1u);
  ASSERT_EQ(log.frames[0].landmark_scans.size(), 1u);
  EXPECT_EQ(log.frames[0].landmark_scans[0].measurements.size(), 2u);
  EXPECT_EQ(log.report.skipped_landmarks_label, 1u);
  params.landmark_labels = "RIGHT";
  params.sensor_labels = "FRONT";
  EXPECT_THAT(errorOf(builder, params), HasSubstr("the log has 'LASER', 'LEFT', 'TREES'"));
}

TEST(LandmarkScan, CallersMayReadOneKindAlone) {
  const auto both = LogBuilder().add(scanAt(0)).add(treesAt(0, {{4, 0}})).add(treesAt(1, {{4, 0}}));
  ReaderParams grids, landmarks;
  grids.use_landmarks = landmarks.use_scans = false;
  EXPECT_EQ(ReadLog(both, grids).frames.size(), 1u);
  EXPECT_TRUE(ReadLog(both, landmarks).frames.at(0).scans.empty());
  EXPECT_EQ(ReadLog(both, landmarks).frames.size(), 2u);
  EXPECT_THAT(errorOf(LogBuilder().add(treesAt(0, {{4, 0}})), grids),
              AllOf(HasSubstr("no usable 2D laser scan"), HasSubstr("a grid map needs scans")));
  EXPECT_THAT(errorOf(LogBuilder().add(scanAt(0)), landmarks),
              AllOf(HasSubstr("no usable landmark observation"), HasSubstr("a grid map can be made of it")));
}

TEST(LandmarkScan, ReportDescribesTheSensor) {
  const ReadLog log(LogBuilder().add(treesAt(0, {{4, 0}, {8.5, 0.1}})).add(treesAt(1, {})));
  EXPECT_THAT(
      log.report.asText(),
      AllOf(HasSubstr("landmarks 'TREES': 2 observations (1 empty) with 2 measurements, none with id"),
            HasSubstr("farthest 8.50 m, max. range 75.00 m, sigma 0.50 m and 14.32 deg")));
}

TEST(LandmarkScan, DamagedObservationsNeverCrash) {
  TempFolder temp;
  auto own = treesAt(1, {{4, 0, 0, 2}});
  own.validCovariances = true;
  own.sensedData[0].covariance.setIdentity();
  const auto bytes = LogBuilder().add(treesAt(0, {{4, 0, 0, 1}, {5, 1}})).add(own).bytes();
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    auto flipped = bytes;
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << (at % 8)));
    EXPECT_LE(checkLog(temp.write("a.rawlog", flipped)).frames, 2u) << at;
  }
}

}  // namespace
}  // namespace submap_slam
