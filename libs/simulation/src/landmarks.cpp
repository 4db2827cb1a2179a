#include <submap_slam/simulation/landmarks.h>

#include <fmt/format.h>
#include <mrpt/math/wrap2pi.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/simulation/normal_generator.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "constants.h"
#include "log_time.h"
#include "require.h"

namespace submap_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using mrpt::math::TTwist2D;

/** Uniform in (0, 1], from two normal numbers: their squared norm is exponentially distributed. */
double uniform(NormalGenerator& normal) {
  const double a = normal(), b = normal();
  return std::exp(-(a * a + b * b) / 2);
}

TPose2D roundedPose(const TPose2D& pose) {
  return {rounded(pose.x, kOdometryStep), rounded(pose.y, kOdometryStep), rounded(pose.phi, kOdometryStep)};
}

/** Measures how a bicycle is driven. */
class Controls {
 public:
  Controls(const ControlModel& model, uint64_t seed)
      : model_(model), bicycle_(vehicleOf(model)), normal_(seed, kControlStream) {}

  /** The measured velocities of a step that takes dt (s). */
  TTwist2D measure(const TPose2D& step, double dt) {
    const TTwist2D true_velocity(std::copysign(std::hypot(step.x, step.y), step.x) / dt, 0, step.phi / dt);
    if (true_velocity.vx == 0 && true_velocity.omega != 0)
      throw ConfigError("a car cannot turn on the spot; the route has too sharp a corner");
    CarControl control = controlOf(true_velocity, bicycle_);
    control.encoder_speed += model_.sigma_velocity * normal_();
    control.steering += model_.sigma_steering * normal_();
    const TTwist2D v = velocityOf(control, bicycle_);
    return {rounded(v.vx, kOdometryStep), 0, rounded(v.omega, kOdometryStep)};
  }

 private:
  const ControlModel& model_;
  VehicleParams bicycle_;
  NormalGenerator normal_;
};

class Sensor {
 public:
  Sensor(const LandmarkSensor& model, uint64_t seed) : model_(model), normal_(seed, kSensorStream) {}

  LandmarkScan scanFrom(const TPose2D& robot, const std::vector<TrueLandmark>& landmarks) {
    LandmarkScan scan;
    scan.sensor_label = "LANDMARKS";
    scan.max_range = model_.max_range;
    scan.field_of_view = model_.field_of_view;
    scan.sigma_range = model_.sigma_range;
    scan.sigma_bearing = model_.sigma_bearing;
    for (const TrueLandmark& landmark : landmarks)
      if (auto seen = measure(robot, landmark)) scan.measurements.push_back(*seen);
    return scan;
  }

 private:
  std::optional<LandmarkMeasurement> measure(const TPose2D& robot, const TrueLandmark& landmark) {
    constexpr double kNearest = 0.1;  // m; noise never puts a landmark behind the sensor
    const TPoint2D offset = landmark.position - TPoint2D(robot.x, robot.y);
    const double range = offset.norm();
    const double bearing = mrpt::math::wrapToPi(std::atan2(offset.y, offset.x) - robot.phi);
    if (range < kNearest || range > model_.max_range || std::abs(bearing) > model_.field_of_view / 2)
      return std::nullopt;
    const double measured_range = std::max(kNearest, range + model_.sigma_range * normal_());
    return LandmarkMeasurement{measured_range,
                               mrpt::math::wrapToPi(bearing + model_.sigma_bearing * normal_()), landmark.id};
  }

  const LandmarkSensor& model_;
  NormalGenerator normal_;
};

/** A rectangle of this width and depth (m) with its lower side along the x axis. */
WayPoints rectangle(double width, double depth) {
  return {{width / 2, 0}, {width / 2, depth}, {-width / 2, depth}, {-width / 2, 0}};
}

/** From the origin around a rectangle some times, ending on its lower side at x = end (m). */
WayPoints roundsOf(const WayPoints& corners, int rounds, double end) {
  WayPoints route{{0, 0}};
  for (int i = 0; i < rounds; ++i) route.insert(route.end(), corners.begin(), corners.end());
  route.emplace_back(end, 0);
  return route;
}

}  // namespace

void validate(const LandmarkField& field) {
  require(field.count >= 1, "landmarks", "at least 1");
  requireNotNegative(field.spread, "landmark_spread");
}

void validate(const ControlModel& control) {
  require(control.wheel_base > 0 && std::isfinite(control.wheel_base), "wheel_base", "positive");
  requireNotNegative(control.sigma_velocity, "sigma_velocity");
  requireNotNegative(control.sigma_steering, "sigma_steering");
  require(control.readings_per_scan >= 1, "readings_per_scan", "at least 1");
}

VehicleParams vehicleOf(const ControlModel& control) {
  VehicleParams vehicle;
  vehicle.model = "ackermann";
  vehicle.wheel_base = control.wheel_base;
  vehicle.encoder_offset = 0;
  vehicle.sigma_velocity = control.sigma_velocity;
  vehicle.sigma_steering = control.sigma_steering;
  vehicle.stabilising_xy = vehicle.stabilising_turn = 0;
  return vehicle;
}

void validate(const LandmarkSensor& sensor) {
  require(sensor.max_range > 0 && std::isfinite(sensor.max_range), "max_range", "positive");
  require(sensor.field_of_view > 0 && sensor.field_of_view < 6.2832, "field_of_view", "in (0, 2π] rad");
  requireNotNegative(sensor.sigma_range, "sigma_range");
  requireNotNegative(sensor.sigma_bearing, "sigma_bearing");
}

std::vector<TrueLandmark> plantLandmarks(const LandmarkField& field, const Path& path) {
  validate(field);
  if (path.poses.empty()) throw ConfigError("the path to simulate is empty");
  NormalGenerator normal(static_cast<uint64_t>(field.place_seed), kPlaceStream);
  std::vector<TrueLandmark> landmarks;
  for (int i = 0; i < field.count; ++i) {
    const double along = uniform(normal) * static_cast<double>(path.poses.size() - 1);
    const double aside = field.spread * (2 * uniform(normal) - 1);
    const TPoint2D position = path.poses[static_cast<std::size_t>(along)].composePoint(TPoint2D(0, aside));
    landmarks.push_back({static_cast<uint32_t>(i + 1), position});
  }
  return landmarks;
}

SimulatedLog simulateLandmarks(const std::vector<TrueLandmark>& landmarks, const Path& path,
                               const LandmarkSensor& sensor_model, const ControlModel& control_model,
                               uint64_t seed) {
  validate(sensor_model);
  validate(control_model);
  if (path.poses.empty()) throw ConfigError("the path to simulate is empty");
  Controls controls(control_model, seed);
  Sensor sensor(sensor_model, seed);
  SimulatedLog log;
  log.landmarks = landmarks;
  TPose2D odometry(0, 0, 0);
  for (std::size_t k = 0; k < path.poses.size(); ++k) {
    const bool last = k + 1 == path.poses.size();
    const TPose2D step = last ? TPose2D(0, 0, 0) : path.poses[k + 1] - path.poses[k];
    log.velocities.push_back(
        {stampOf(k, path.period), roundedPose(odometry), controls.measure(step, path.period)});
    const VelocityReading& reading = log.velocities.back();
    if (k % static_cast<std::size_t>(control_model.readings_per_scan) == 0) {
      Frame frame;
      frame.index = log.frames.size();
      frame.stamp = reading.stamp;
      frame.odometry = reading.pose;
      frame.landmark_scans.push_back(sensor.scanFrom(path.poses[k], landmarks));
      log.frames.push_back(std::move(frame));
      log.truth.push_back({reading.stamp, path.poses[k]});
    }
    odometry = moved(odometry, reading.velocity, path.period);
  }
  return log;
}

std::vector<std::string> roadNames() { return {"landmarks_a", "landmarks_b", "landmarks_block"}; }

Road makeRoad(const std::string& name) {
  if (name == "landmarks_a") return {name, roundsOf(rectangle(1620, 1620), 1, 300)};
  if (name == "landmarks_b") return {name, roundsOf(rectangle(820, 820), 2, 0)};
  if (name == "landmarks_block") return {name, roundsOf(rectangle(100, 60), 1, 30)};
  throw ConfigError(fmt::format("unknown road '{}': expected one of {}", name, fmt::join(roadNames(), ", ")));
}

}  // namespace submap_slam
