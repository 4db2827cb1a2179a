#include <fmt/format.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPose3D.h>
#include <submap_slam/core/errors.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "forms.h"
#include "laser_scan.h"
#include "rawlog_output.h"
#include "text_lines.h"
#include "words.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::math::TTwist2D;

/** Where the robot was by its wheels. */
struct OdometryReading {
  double stamp_s = 0;
  TPose2D T_odom_robot;
  std::optional<TTwist2D> velocity;  ///< of the robot, in its own frame: m/s, rad/s
};

/** `stamp x y theta`, or TUM: `stamp x y z qx qy qz qw`. */
OdometryReading readPoseLine(std::string_view line) {
  Words words(line);
  const bool tum = words.left() == 8;
  OdometryReading reading;
  reading.stamp_s = words.number("the stamp");
  reading.T_odom_robot.x = words.number("x");
  reading.T_odom_robot.y = words.number("y");
  if (tum) {
    for (const char* what : {"z", "qx", "qy"}) words.number(what);
    const double qz = words.number("qz");
    reading.T_odom_robot.phi = 2 * std::atan2(qz, words.number("qw"));
  } else {
    reading.T_odom_robot.phi = words.number("theta");
  }
  words.requireEnd();
  return reading;
}

/** Integrates controls `stamp speed turn`, each of which holds until the next one.
 *
 * With a steering angle g, wheel base L and the encoder H to the left of the centre of the rear axle its
 * speed v_e becomes that of the centre, v = v_e / (1 − tan(g) H / L), and the yaw rate ω = v tan(g) / L
 * (Guivant and Nebot, IEEE T-RA 17(3), 2001, section III). */
class ControlTrack {
 public:
  explicit ControlTrack(const ImportOptions& options)
      : wheel_base_(options.wheel_base), encoder_offset_(options.encoder_offset) {}

  OdometryReading next(std::string_view line) {
    Words words(line);
    const double stamp_s = words.number("the stamp");
    const double speed = words.number("the speed");
    const double turn = words.number("the steering angle or yaw rate");
    words.requireEnd();
    if (last_.velocity) {
      const double dt = stamp_s - last_.stamp_s;
      if (dt < 0) throw LineError("the stamp is before that of the line above");
      last_.T_odom_robot = last_.T_odom_robot + arc(*last_.velocity, dt);
    }
    last_.stamp_s = stamp_s;
    last_.velocity = velocityOf(speed, turn);
    return last_;
  }

 private:
  TTwist2D velocityOf(double speed, double turn) const {
    if (wheel_base_ <= 0) return {speed, 0, turn};
    const double v = speed / (1 - std::tan(turn) * encoder_offset_ / wheel_base_);
    return {v, 0, v * std::tan(turn) / wheel_base_};
  }

  /** Motion at constant velocity: an arc. */
  static TPose2D arc(const TTwist2D& velocity, double dt) {
    const double distance = velocity.vx * dt, angle = velocity.omega * dt;
    if (std::abs(angle) < 1e-9) return {distance, 0, angle};
    const double radius = distance / angle;
    return {radius * std::sin(angle), radius * (1 - std::cos(angle)), angle};
  }

  double wheel_base_, encoder_offset_;
  OdometryReading last_;
};

std::vector<OdometryReading> readOdometry(const ImportJob& job) {
  const bool controls = !job.options.controls_file.empty();
  const std::string& file = controls ? job.options.controls_file : job.options.odometry_file;
  ControlTrack track(job.options);
  std::vector<OdometryReading> readings;
  forEachLine(
      file,
      [&](std::string_view line) { readings.push_back(controls ? track.next(line) : readPoseLine(line)); },
      &job.report, {});
  if (readings.empty()) throw InputError(fmt::format("{}: holds no odometry", file));
  const auto earlier = [](const auto& a, const auto& b) { return a.stamp_s < b.stamp_s; };
  std::stable_sort(readings.begin(), readings.end(), earlier);
  return readings;
}

/** Writes landmarks and odometry in the order of their stamps. */
class LandmarkLog {
 public:
  explicit LandmarkLog(const ImportJob& job) : job_(job), odometry_(readOdometry(job)), out_(job.output) {
    observation_.sensorLabel = "LANDMARKS";
    observation_.sensorLocationOnRobot =
        mrpt::poses::CPose3D(mrpt::poses::CPose2D(job.options.T_robot_sensor.value_or(TPose2D())));
    observation_.maxSensorDistance = static_cast<float>(job.options.max_range.value_or(0));
  }

  /** `stamp range bearing [id]`, or `stamp` alone where nothing was seen. Lines of one stamp are one
   * observation. */
  void readLine(std::string_view line) {
    Words words(line);
    const std::size_t count = words.left();
    const double stamp_s = words.number("the stamp");
    if (stamp_ && stamp_s < *stamp_) throw LineError("the stamp is before that of the line above");
    std::optional<mrpt::obs::CObservationBearingRange::TMeasurement> seen;
    if (count > 1) seen = readMeasurement(words, count > 3);
    words.requireEnd();
    if (!stamp_ || stamp_s > *stamp_) begin(stamp_s);
    if (seen) requireNewId(seen->landmarkID);
    if (seen) observation_.sensedData.push_back(*seen);
    if (seen) ++job_.report.written["landmark measurements"];
  }

  void close() {
    writeObservation();
    writeOdometryBefore(std::numeric_limits<double>::infinity());
    out_.close();
  }

 private:
  static mrpt::obs::CObservationBearingRange::TMeasurement readMeasurement(Words& words, bool has_id) {
    mrpt::obs::CObservationBearingRange::TMeasurement seen;
    seen.range = static_cast<float>(words.number("the range"));
    if (seen.range <= 0) throw LineError("the range is not above 0");
    seen.yaw = static_cast<float>(words.number("the bearing"));
    seen.pitch = 0;
    constexpr uint32_t kMostId = std::numeric_limits<int32_t>::max();
    const uint32_t id = has_id ? words.wholeNumber("the id of the landmark") : 0;
    if (id > kMostId) throw LineError(fmt::format("id {}: expected at most {}", id, kMostId));
    seen.landmarkID = has_id ? static_cast<int32_t>(id) : mrpt::obs::INVALID_LANDMARK_ID;
    return seen;
  }

  /** MRPT cannot hold an id twice in one observation. */
  void requireNewId(int32_t id) const {
    const auto has_it = [id](const auto& before) { return before.landmarkID == id; };
    const auto& others = observation_.sensedData;
    if (id != mrpt::obs::INVALID_LANDMARK_ID && std::any_of(others.begin(), others.end(), has_it))
      throw LineError(fmt::format("id {} stands at this stamp already", id));
  }

  void begin(double stamp_s) {
    writeObservation();
    stamp_ = stamp_s;
    observation_.timestamp = mrpt::Clock::fromDouble(stamp_s);
  }

  void writeObservation() {
    if (!stamp_) return;
    writeOdometryBefore(*stamp_);
    out_.write(observation_);
    observation_.sensedData.clear();
    ++job_.report.written["landmark observations"];
  }

  void writeOdometryBefore(double stamp_s) {
    for (; next_ < odometry_.size() && odometry_[next_].stamp_s <= stamp_s; ++next_) {
      auto reading = makeOdometry(odometry_[next_].stamp_s, odometry_[next_].T_odom_robot);
      reading.hasVelocities = odometry_[next_].velocity.has_value();
      if (reading.hasVelocities) reading.velocityLocal = *odometry_[next_].velocity;
      out_.write(reading);
      ++job_.report.written["odometry readings"];
    }
  }

  ImportJob job_;
  std::vector<OdometryReading> odometry_;
  std::size_t next_ = 0;
  RawlogOutput out_;
  mrpt::obs::CObservationBearingRange observation_;
  std::optional<double> stamp_;
};

}  // namespace

void importLandmarks(const ImportJob& job) {
  if (job.options.odometry_file.empty() == job.options.controls_file.empty())
    throw ConfigError("landmarks need either --odometry or --controls");
  LandmarkLog log(job);
  forEachLine(
      job.file, [&](std::string_view line) { log.readLine(line); }, &job.report, job.progress);
  log.close();
}

}  // namespace submap_slam
