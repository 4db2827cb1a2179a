#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/zip.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/simulation/scenario.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace submap_slam {
namespace {

using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CRawlog;

SimulatedLog shortLog(uint64_t seed) {
  const World world = roomWorld();
  return simulate(world, drive({{1.5, 7.5}, {3, 7.5}, {3, 4.5}}, {}, 5), LaserModel{}, OdometryModel{}, seed);
}

/** Content of a file without its compression, which may differ between versions of zlib. */
std::vector<uint8_t> unpacked(const std::string& file) {
  std::vector<uint8_t> content;
  EXPECT_TRUE(mrpt::io::zip::decompress_gz_file(file, content)) << file;
  return content;
}

std::string bytesOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void expectSameScan(const CObservation2DRangeScan& read, const CObservation2DRangeScan& written) {
  EXPECT_EQ(read.timestamp, written.timestamp);
  EXPECT_EQ(read.sensorLabel, written.sensorLabel);
  EXPECT_EQ(read.aperture, written.aperture);
  EXPECT_EQ(read.rightToLeft, written.rightToLeft);
  EXPECT_EQ(read.maxRange, written.maxRange);
  EXPECT_EQ(read.stdError, written.stdError);
  EXPECT_EQ(read.sensorPose.asTPose(), written.sensorPose.asTPose());
  ASSERT_EQ(read.getScanSize(), written.getScanSize());
  for (std::size_t i = 0; i < read.getScanSize(); ++i) {
    ASSERT_EQ(read.getScanRange(i), written.getScanRange(i));
    ASSERT_EQ(read.getScanRangeValidity(i), written.getScanRangeValidity(i));
  }
}

class RawlogFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string file(const std::string& name) const { return (folder / name).string(); }

  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) /
      (std::string("simulation_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(RawlogFile, OfObservationsHoldsScansAndOdometry) {
  const SimulatedLog log = shortLog(4);
  writeRawlog(file("a.rawlog"), log, RawlogForm::kObservations);
  CRawlog rawlog;
  ASSERT_TRUE(rawlog.loadFromRawLogFile(file("a.rawlog")));
  ASSERT_EQ(rawlog.size(), 2 * log.frames.size());
  for (std::size_t k = 0; k < log.frames.size(); ++k) {
    const auto odometry = rawlog.asObservation<mrpt::obs::CObservationOdometry>(2 * k);
    ASSERT_TRUE(odometry);
    EXPECT_EQ(odometry->timestamp, log.frames[k].stamp);
    EXPECT_EQ(odometry->odometry.asTPose(), *log.frames[k].odometry);
    const auto scan = rawlog.asObservation<CObservation2DRangeScan>(2 * k + 1);
    ASSERT_TRUE(scan);
    expectSameScan(*scan, *log.frames[k].scans[0]);
  }
}

TEST_F(RawlogFile, OfActionsHoldsScansAndIncrementsThatAddUpToTheOdometry) {
  const SimulatedLog log = shortLog(4);
  writeRawlog(file("a_sf.rawlog"), log, RawlogForm::kActions);
  CRawlog rawlog;
  ASSERT_TRUE(rawlog.loadFromRawLogFile(file("a_sf.rawlog")));
  ASSERT_EQ(rawlog.size(), 2 * log.frames.size());
  mrpt::poses::CPose2D sum;
  for (std::size_t k = 0; k < log.frames.size(); ++k) {
    const auto movement = rawlog.getAsAction(2 * k)->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
    ASSERT_TRUE(movement);
    EXPECT_EQ(movement->timestamp, log.frames[k].stamp);
    sum = sum + movement->rawOdometryIncrementReading;
    EXPECT_NEAR(sum.x(), log.frames[k].odometry->x, 1e-9);
    EXPECT_NEAR(sum.y(), log.frames[k].odometry->y, 1e-9);
    EXPECT_NEAR(std::remainder(sum.phi() - log.frames[k].odometry->phi, 2 * M_PI), 0, 1e-9);
    const auto scan = rawlog.getAsObservations(2 * k + 1)->getObservationByClass<CObservation2DRangeScan>();
    ASSERT_TRUE(scan);
    expectSameScan(*scan, *log.frames[k].scans[0]);
  }
}

SimulatedLog shortDrive() {
  Scenario scenario = makeScenario("landmarks_block");
  scenario.max_scans = 30;
  return simulate(scenario, 1);
}

void expectSameLandmarks(const mrpt::obs::CObservationBearingRange& read, const LandmarkScan& written) {
  EXPECT_EQ(read.sensorLabel, written.sensor_label);
  EXPECT_EQ(read.maxSensorDistance, static_cast<float>(written.max_range));
  EXPECT_EQ(read.sensor_std_range, static_cast<float>(written.sigma_range));
  ASSERT_EQ(read.sensedData.size(), written.measurements.size());
  for (std::size_t i = 0; i < read.sensedData.size(); ++i) {
    EXPECT_EQ(read.sensedData[i].range, static_cast<float>(written.measurements[i].range));
    EXPECT_EQ(read.sensedData[i].yaw, static_cast<float>(written.measurements[i].bearing));
    EXPECT_EQ(read.sensedData[i].landmarkID, static_cast<int32_t>(*written.measurements[i].id));
  }
}

TEST_F(RawlogFile, HoldsLandmarksBehindTheVelocitiesUpToThem) {
  const SimulatedLog log = shortDrive();
  writeRawlog(file("a.rawlog"), log, RawlogForm::kObservations);
  CRawlog rawlog;
  ASSERT_TRUE(rawlog.loadFromRawLogFile(file("a.rawlog")));
  ASSERT_EQ(rawlog.size(), log.velocities.size() + log.frames.size());
  std::size_t reading = 0, frame = 0;
  for (std::size_t i = 0; i < rawlog.size(); ++i) {
    const auto observation = rawlog.getAsObservation(i);
    if (const auto odometry = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(observation)) {
      EXPECT_TRUE(odometry->hasVelocities);
      EXPECT_EQ(odometry->velocityLocal.omega, log.velocities[reading++].velocity.omega);
      continue;
    }
    const auto landmarks = std::dynamic_pointer_cast<mrpt::obs::CObservationBearingRange>(observation);
    ASSERT_TRUE(landmarks);
    EXPECT_EQ(landmarks->timestamp, log.velocities[reading - 1].stamp);
    expectSameLandmarks(*landmarks, log.frames[frame++].landmark_scans[0]);
  }
}

TEST_F(RawlogFile, OfActionsHoldsLandmarks) {
  const SimulatedLog log = shortDrive();
  writeRawlog(file("a.rawlog"), log, RawlogForm::kActions);
  CRawlog rawlog;
  ASSERT_TRUE(rawlog.loadFromRawLogFile(file("a.rawlog")));
  ASSERT_EQ(rawlog.size(), 2 * log.frames.size());
  expectSameLandmarks(
      *rawlog.getAsObservations(3)->getObservationByClass<mrpt::obs::CObservationBearingRange>(),
      log.frames[1].landmark_scans[0]);
}

TEST_F(RawlogFile, TrueLandmarksAreATable) {
  writeTrueLandmarks(file("a.csv"), {{7, {1.5, -2}}});
  EXPECT_EQ(bytesOf(file("a.csv")), "id,x,y\n7,1.500000,-2.000000\n");
}

TEST_F(RawlogFile, EndsWithItsLastObject) {
  writeRawlog(file("a.rawlog"), shortLog(4), RawlogForm::kObservations);
  CRawlog rawlog;
  ASSERT_TRUE(rawlog.loadFromRawLogFile(file("a.rawlog")));
  const std::size_t objects = rawlog.size();
  mrpt::io::CFileGZInputStream in(file("a.rawlog"));
  auto archive = mrpt::serialization::archiveFrom(in);
  for (std::size_t i = 0; i < objects; ++i) ASSERT_TRUE(archive.ReadObject());
  char beyond = 0;
  EXPECT_EQ(in.Read(&beyond, 1), 0u);
}

TEST_F(RawlogFile, HasTheSameBytesForTheSameSeedOnly) {
  for (const RawlogForm form : {RawlogForm::kObservations, RawlogForm::kActions}) {
    writeRawlog(file("a.rawlog"), shortLog(4), form);
    writeRawlog(file("b.rawlog"), shortLog(4), form);
    writeRawlog(file("c.rawlog"), shortLog(5), form);
    EXPECT_TRUE(bytesOf(file("a.rawlog")) == bytesOf(file("b.rawlog")));
    EXPECT_FALSE(bytesOf(file("a.rawlog")) == bytesOf(file("c.rawlog")));
  }
}

TEST_F(RawlogFile, CarriesNoTimeOfWritingInItsGzipHeader) {
  writeRawlog(file("a.rawlog"), shortLog(4), RawlogForm::kObservations);
  const std::string bytes = bytesOf(file("a.rawlog"));
  EXPECT_EQ(bytes.substr(0, 2), "\x1f\x8b");
  EXPECT_EQ(bytes.substr(3, 5), std::string(5, '\0'));  // no file name, no time
}

TEST_F(RawlogFile, ThatCannotBeWrittenIsNamed) {
  const SimulatedLog log = shortLog(4);
  for (const std::string& bad : {file("no/such/folder/a.rawlog"), std::string("/dev/full")}) {
    try {
      writeRawlog(bad, log, RawlogForm::kObservations);
      ADD_FAILURE() << "no error for " << bad;
    } catch (const OutputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(bad));
    }
    EXPECT_THROW(writeTruth(bad, log.truth), OutputError);
  }
}

TEST_F(RawlogFile, HasTruthInTumFormat) {
  const auto stamp = mrpt::Clock::fromDouble(1577836800.2);
  writeTruth(file("a.truth.tum"), {{stamp, {1.5, -2.25, M_PI / 2}}});
  std::istringstream line(bytesOf(file("a.truth.tum")));
  double values[8];
  for (double& value : values) line >> value;
  EXPECT_NEAR(values[0], 1577836800.2, 1e-6);
  EXPECT_THAT(std::vector<double>(values + 1, values + 6), testing::ElementsAre(1.5, -2.25, 0, 0, 0));
  EXPECT_NEAR(values[6], std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(values[7], std::sqrt(0.5), 1e-9);
  EXPECT_EQ(line.get(), '\n');
}

TEST_F(RawlogFile, ExamplesAreThoseOfTheRepository) {
  writeExampleLogs(folder.string());
  for (const std::string name :
       {"room", "corridor_sf", "loop", "non_convex", "long_corridors", "landmarks"}) {
    for (const std::string ending : {".rawlog", ".truth.tum"}) {
      const auto expected = unpacked(SUBMAP_SLAM_SOURCE_DIR "/rawlogs/" + name + ending);
      ASSERT_FALSE(expected.empty()) << name + ending;
      EXPECT_TRUE(unpacked(file(name + ending)) == expected) << name + ending;
    }
    EXPECT_LT(std::filesystem::file_size(file(name + ".rawlog")), 400000u);
  }
  EXPECT_EQ(bytesOf(file("landmarks.landmarks.csv")),
            bytesOf(SUBMAP_SLAM_SOURCE_DIR "/rawlogs/landmarks.landmarks.csv"));
}

}  // namespace
}  // namespace submap_slam
