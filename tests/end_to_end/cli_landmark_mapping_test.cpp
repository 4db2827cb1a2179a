/** From a log with measured landmarks to a map of them. */
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/landmark_submap.h>
#include <submap_slam/rawlog/landmark_log.h>
#include <submap_slam/rawlog/submap_log.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "cli_fixture.h"

namespace submap_slam::testing {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Key;
using ::testing::StartsWith;

constexpr int kFrames = 240;
constexpr double kRadius = 15, kRange = 12;

/** Twice round a circle of 15 m between 24 landmarks, measured without noise, odometry 2 % too short. */
class CliLandmarkMapping : public CliTest {
 protected:
  CliLandmarkMapping() {
    writeLog(path("ids.rawlog"), true, true);
    writeLog(path("positions.rawlog"), false, true);
    writeLog(path("nothing.rawlog"), false, false);
  }

  nlohmann::json metrics(const std::string& folder) const {
    return nlohmann::json::parse(contentOf(path(folder + "/metrics.json")));
  }

  std::vector<std::string> map(const std::string& log, const std::string& out,
                               std::vector<std::string> more = {}) const {
    std::vector<std::string> command{"map", path(log), "-o", path(out), "-q"};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }

 private:
  static TPose2D poseAt(int k) {
    const double angle = 4 * M_PI * k / kFrames;
    return {kRadius * std::sin(angle), kRadius * (1 - std::cos(angle)), angle};
  }

  static mrpt::obs::CObservationBearingRange measure(const TPose2D& robot, bool ids) {
    mrpt::obs::CObservationBearingRange out;
    out.sensorLabel = "TREES";
    out.maxSensorDistance = static_cast<float>(kRange);
    out.fieldOfView_yaw = static_cast<float>(M_PI);
    out.sensor_std_range = 0.05f, out.sensor_std_yaw = 0.01f;
    for (int i = 0; i < 24; ++i) {
      const double angle = 2 * M_PI * i / 24, radius = i % 2 == 0 ? 19.0 : 11.0;
      const TPoint2D landmark(radius * std::sin(angle), kRadius - radius * std::cos(angle));
      const TPoint2D p = robot.inverseComposePoint(landmark);
      if (std::hypot(p.x, p.y) > kRange || p.x < 0) continue;
      mrpt::obs::CObservationBearingRange::TMeasurement m;
      m.range = static_cast<float>(std::hypot(p.x, p.y));
      m.yaw = static_cast<float>(std::atan2(p.y, p.x));
      m.pitch = 0;
      m.landmarkID = ids ? i : mrpt::obs::INVALID_LANDMARK_ID;
      out.sensedData.push_back(m);
    }
    return out;
  }

  static void writeLog(const std::string& file, bool ids, bool landmarks) {
    mrpt::io::CFileGZOutputStream stream(file);
    auto archive = mrpt::serialization::archiveFrom(stream);
    TPose2D odometry;
    for (int k = 0; k < kFrames; ++k) {
      if (k > 0) {
        const TPose2D step = poseAt(k) - poseAt(k - 1);
        odometry = odometry + TPose2D(0.98 * step.x, step.y, step.phi);
      }
      mrpt::obs::CObservationOdometry reading;
      reading.timestamp = mrpt::Clock::fromDouble(1000 + 0.2 * k);
      reading.sensorLabel = "ODOMETRY";
      reading.odometry = mrpt::poses::CPose2D(odometry);
      archive << reading;
      auto scan = measure(poseAt(k), ids);
      if (!landmarks) scan.sensedData.clear();
      scan.timestamp = reading.timestamp;
      archive << scan;
    }
  }
};

TEST_F(CliLandmarkMapping, MapsALogWithIds) {
  succeed(map("ids.rawlog", "out"));
  const auto results = contentsOf(path("out"));
  for (const char* name : {"map.png", "map.3Dscene", "landmarks.csv", "association.csv", "trajectory.tum",
                           "landmark_submaps.rawlog", "metrics.json", "config.ini", "log.txt"})
    EXPECT_THAT(results, Contains(Key(name)));
  const auto m = metrics("out");
  EXPECT_EQ(m["landmarks"], 24);
  EXPECT_EQ(m["association"], "known");
  EXPECT_EQ(m["frames"], kFrames);
  EXPECT_GE(m["submaps"], 3);
  EXPECT_EQ(lines(results.at("trajectory.tum")), 1u + kFrames) << "a head and every frame";
  EXPECT_FALSE(readLandmarkSubmaps(path("out/landmark_submaps.rawlog"))[0]->nodes.empty());
}

TEST_F(CliLandmarkMapping, IniFilesOfTheProductAreTaken) {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SUBMAP_SLAM_SOURCE_DIR "/ini")) {
    if (entry.path().extension() != ".ini") continue;
    succeed({"check", entry.path().string(), log("landmarks.rawlog")});
    ++files;
  }
  EXPECT_GE(files, 3u);
  succeed(map("positions.rawlog", "out", {"-c", SUBMAP_SLAM_SOURCE_DIR "/ini/landmarks.ini"}));
  EXPECT_EQ(metrics("out")["landmarks"], 24);
  succeed(map("positions.rawlog", "defaults", {"--set", "mapping.maps=landmarks"}));
  EXPECT_EQ(contentOf(path("out/config.ini")), contentOf(path("defaults/config.ini")))
      << "all else in it is as in default.ini";
}

TEST_F(CliLandmarkMapping, FindsTheLandmarksAgainWithoutIds) {
  succeed(map("positions.rawlog", "out"));
  const auto m = metrics("out");
  EXPECT_EQ(m["association"], "unknown");
  EXPECT_EQ(m["landmarks"], 24) << "the second round sees those of the first";
  EXPECT_FALSE(m.contains("association_wrong")) << "there are no ids to compare with";
}

TEST_F(CliLandmarkMapping, BuildAndJoinGiveTheSameAsMap) {
  succeed(map("positions.rawlog", "out"));
  succeed({"build", path("positions.rawlog"), "-o", path("s.rawlog"), "-q"});
  succeed({"join", path("s.rawlog"), "-o", path("joined"), "-q"});
  for (const char* file : {"landmarks.csv", "trajectory.tum", "association.csv", "map.png"})
    EXPECT_EQ(contentOf(path("out/") + file), contentOf(path("joined/") + file)) << file;
}

TEST_F(CliLandmarkMapping, AnyNumberOfThreadsAndUpdatesOnTheWayGiveTheSameBytes) {
  for (const char* log : {"ids.rawlog", "positions.rawlog"}) {
    const std::string a = std::string("a_") + log, b = std::string("b_") + log;
    succeed(map(log, a, {"--threads", "1"}));
    succeed(map(log, b, {"--threads", "3", "--incremental"}));
    for (const char* file : {"landmarks.csv", "trajectory.tum", "map.png", "landmark_submaps.rawlog"})
      EXPECT_EQ(contentOf(path(a + "/" + file)), contentOf(path(b + "/" + file))) << log << " " << file;
    EXPECT_GE(lines(contentOf(path(b + "/updates.csv"))), 3u);
  }
}

TEST_F(CliLandmarkMapping, ASingleMapIsOneSubmap) {
  for (const char* method : {"ekf", "rbpf"}) {
    succeed(map("ids.rawlog", method,
                {"--set", "landmark_mapper.single_map=true", "--set",
                 std::string("landmark_mapper.method=") + method}));
    EXPECT_EQ(metrics(method)["submaps"], 1);
    EXPECT_EQ(metrics(method)["landmarks"], 24);
  }
}

/** The example loop with landmarks in a lattice of 6 m, measured from the true poses with the noise that is
 * stated. */
void addLandmarks(const std::string& log, const std::string& truth, const std::string& out) {
  std::mt19937 random(1);
  std::normal_distribution<double> range_noise(0, 0.05), bearing_noise(0, 0.01);
  std::ifstream poses(truth);
  mrpt::io::CFileGZInputStream from(log);
  mrpt::io::CFileGZOutputStream to(out);
  auto reader = mrpt::serialization::archiveFrom(from);
  auto writer = mrpt::serialization::archiveFrom(to);
  for (double t, x, y, z, qx, qy, qz, qw; poses >> t >> x >> y >> z >> qx >> qy >> qz >> qw;) {
    mrpt::serialization::CSerializable::Ptr object;
    do {
      object = reader.ReadObject();
      writer << *object;
    } while (!std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(object));
    mrpt::obs::CObservationBearingRange seen;
    seen.timestamp = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object)->timestamp;
    seen.sensorLabel = "POSTS";
    seen.maxSensorDistance = 8, seen.fieldOfView_yaw = static_cast<float>(M_PI);
    seen.sensor_std_range = 0.05f, seen.sensor_std_yaw = 0.01f;
    const TPose2D robot(x, y, 2 * std::atan2(qz, qw));
    for (int i = -10; i <= 10; ++i)
      for (int j = -10; j <= 10; ++j) {
        const TPoint2D p = robot.inverseComposePoint(TPoint2D(6.0 * i, 6.0 * j + 0.4 * i));
        if (std::hypot(p.x, p.y) > 8 || p.x < 0) continue;
        mrpt::obs::CObservationBearingRange::TMeasurement m;
        m.range = static_cast<float>(std::hypot(p.x, p.y) + range_noise(random));
        m.yaw = static_cast<float>(std::atan2(p.y, p.x) + bearing_noise(random));
        m.pitch = 0;
        m.landmarkID = mrpt::obs::INVALID_LANDMARK_ID;
        seen.sensedData.push_back(m);
      }
    writer << seen;
  }
}

std::vector<TPose2D> odometryOf(const std::string& submap_file) {
  std::vector<TPose2D> odometry;
  SubmapLogReader reader(submap_file);
  while (const auto submap = reader.next())
    for (const SubmapNode& node : submap->nodes) odometry.push_back(node.odometry.value());
  return odometry;
}

TEST_F(CliLandmarkMapping, GridsAndLandmarksOfTheSameSubmapsAgree) {
  addLandmarks(log("loop.rawlog"), log("loop.truth.tum"), path("both.rawlog"));
  succeed(map("both.rawlog", "out", {"--set", "mapping.maps=grid, landmarks"}));
  const auto results = contentsOf(path("out"));
  for (const char* name : {"map.png", "trajectory.tum", "submaps.rawlog", "landmark_map.png", "landmarks.csv",
                           "landmark_trajectory.tum", "landmark_submaps.rawlog"})
    EXPECT_THAT(results, Contains(Key(name)));
  EXPECT_THAT(results.at("frames.csv"), StartsWith("submap,")) << "of the grids";
  EXPECT_THAT(results.at("landmark_frames.csv"), StartsWith("stamp,"));
  const auto m = metrics("out");
  EXPECT_EQ(m["submaps"], m["landmark_submaps"]) << "the same stretches";
  EXPECT_EQ(lines(results.at("trajectory.tum")), lines(results.at("landmark_trajectory.tum")));
  EXPECT_GT(m["landmark_landmarks"], 20);
  EXPECT_LT(m["landmark_path_difference_m"], 0.1);
  EXPECT_LT(m["landmark_path_difference_deg"], 1.0);
  // Joiners of grids see the odometry of the log, not what landmarks made of it.
  succeed(map("both.rawlog", "grids", {"--set", "mapping.maps=grid"}));
  EXPECT_EQ(odometryOf(path("out/submaps.rawlog")), odometryOf(path("grids/submaps.rawlog")));
  // The path of the landmarks is judged, by its own files.
  const std::string truth = path("out/landmark_trajectory.tum");
  writeFile(path("out/trajectory.tum"), contentOf(log("loop.truth.tum")));  // begins elsewhere
  const auto judged =
      nlohmann::json::parse(succeed({"eval", path("out"), "--reference", truth, "--json"}).out)["landmarks"];
  EXPECT_LT(judged["nees_frames"], 1e-3) << "its own path is the truth";
  // Without asking, the log is mapped by its laser.
  succeed({"build", path("both.rawlog"), "-o", path("s.rawlog"), "-q"});
  EXPECT_FALSE(std::filesystem::exists(path("s_landmarks.rawlog")));
  succeed(map("both.rawlog", "out", {"--overwrite"}));
  EXPECT_FALSE(nlohmann::json::parse(succeed({"eval", path("out"), "--reference", truth, "--json"}).out)
                   .contains("landmarks"))
      << "landmarks.csv is of the run before";
}

TEST_F(CliLandmarkMapping, WarnsWhereGridsAndLandmarksGoDifferentWays) {
  addLandmarks(log("loop.rawlog"), log("loop.truth.tum"), path("both.rawlog"));
  writeFile(path("edits.txt"), "fix 3 0 20 0");  // bends the grids alone
  const auto outcome = succeed(
      map("both.rawlog", "out", {"--set", "mapping.maps=grid, landmarks", "--edits", path("edits.txt")}));
  EXPECT_THAT(outcome.err, HasSubstr("warning: the paths of grids and landmarks differ by "));
  EXPECT_GT(metrics("out")["landmark_path_difference_m"], 1);
}

TEST_F(CliLandmarkMapping, ASingleMapBesideGridsIsRefused) {
  addLandmarks(log("loop.rawlog"), log("loop.truth.tum"), path("both.rawlog"));
  expectRefused(
      run(map("both.rawlog", "out",
              {"--set", "mapping.maps=grid, landmarks", "--set", "landmark_mapper.single_map=true"})),
      "single_map: grids beside landmarks need submaps");
}

TEST_F(CliLandmarkMapping, SaysSoWhereThereIsNothingToMap) {
  const auto outcome = run(map("nothing.rawlog", "out", {"--set", "mapping.maps=landmarks"}));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err,
              HasSubstr("warning: Landmarks 'TREES': no observation has any usable measurement"));
  EXPECT_THAT(outcome.err, HasSubstr("\nsubmap-slam: error: the map would be empty: no landmark"));
  EXPECT_EQ(lines(outcome.err), 2u) << outcome.err;
}

TEST_F(CliLandmarkMapping, RefusesEdits) {
  writeFile(path("edits.txt"), "mask 0");
  expectRefused(run(map("ids.rawlog", "out", {"--edits", path("edits.txt")})),
                "--edits: is for grid submaps");
}

}  // namespace
}  // namespace submap_slam::testing
