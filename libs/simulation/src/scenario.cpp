#include <submap_slam/simulation/scenario.h>

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <algorithm>

#include "constants.h"

namespace submap_slam {
namespace {

/** A scanner of the kind of Hokuyo's UTM-30LX. */
LaserModel wideLaser() {
  LaserModel laser;
  laser.beams = 1081;
  laser.aperture = 1.5 * kPi;
  laser.max_range = 30;
  laser.sigma_range = 0.02;
  return laser;
}

OdometryModel noiseAtEveryFourthScan() {
  OdometryModel odometry = OdometryModel::perfect();
  odometry.fixed_xy = 0.04;
  odometry.fixed_turn = 0.003;
  odometry.fixed_every = 4;
  return odometry;
}

Scenario publishedScenario(World world, double speed, int scans, double duration_s) {
  Scenario scenario;
  scenario.world = std::move(world);
  scenario.drive = {speed, 1.5, 1.0};
  scenario.scan_rate = scans / duration_s;
  scenario.max_scans = scans;
  scenario.laser = wideLaser();
  scenario.odometry = noiseAtEveryFourthScan();
  return scenario;
}

constexpr double kDegree = kPi / 180;
const Range kNotNegative{0};

/** The car of the Combined SLAM paper. */
Scenario drivingScenario(const std::string& road) {
  Scenario scenario;
  scenario.world = {road, {}, makeRoad(road).route};
  scenario.drive = {3, 1.5, 50};
  scenario.landmarks.count = 554;
  if (road != "landmarks_block") return scenario;
  scenario.drive.corner_radius = 10;
  scenario.landmarks.count = 60;
  scenario.landmark_sensor.sigma_range = 0.2;
  scenario.landmark_sensor.sigma_bearing = 2 * kDegree;
  scenario.control.sigma_velocity = 0.1;
  scenario.control.sigma_steering = kDegree;
  scenario.control.readings_per_scan = 4;
  return scenario;
}

void describeDrive(ParameterTable& table, Scenario& scenario) {
  table.add("max_speed", scenario.drive.max_speed, "m/s", {0.01, 100},
            "Speed on straight pieces of the route");
  table.add("max_turn_rate", scenario.drive.max_turn_rate, "rad/s", {0.01, 100}, "Limit in corners");
  table.add("corner_radius", scenario.drive.corner_radius, "m", {0.01, 100},
            "Radius of the arcs that round corners, smaller where the legs are short");
  table.add("scan_rate", scenario.scan_rate, "Hz", {0.01, 1000}, "Scans per second");
  table.add("max_scans", scenario.max_scans, "", kNotNegative,
            "The log ends after this many scans; 0: at the end of the route");
}

void describeCar(ParameterTable& table, Scenario& scenario) {
  LandmarkField& field = scenario.landmarks;
  LandmarkSensor& sensor = scenario.landmark_sensor;
  ControlModel& control = scenario.control;
  table.add("landmarks", field.count, "", {1, 1e6}, "Number of landmarks beside the road");
  table.add("landmark_spread", field.spread, "m", kNotNegative,
            "They stand at most so far to either side of the road");
  table.add("landmark_seed", field.place_seed, "", {0, 1e9},
            "Seed of their places, which do not depend on that of the noise");
  table.add("max_range", sensor.max_range, "m", {0.1, 1000}, "Landmarks farther away are not seen");
  table.add("field_of_view", sensor.field_of_view, "rad", {0.01, 2 * kPi},
            "Angle from the first to the last direction in which landmarks are seen");
  table.add("sigma_range", sensor.sigma_range, "m", kNotNegative, "Standard deviation of a range");
  table.add("sigma_bearing", sensor.sigma_bearing, "rad", kNotNegative, "Standard deviation of a bearing");
  table.add("readings_per_scan", control.readings_per_scan, "", {1, 10000},
            "Readings of speed and steering from one scan to the next");
  table.add("wheel_base", control.wheel_base, "m", {0.01, 100}, "Distance of the axles");
  table.add("sigma_velocity", control.sigma_velocity, "m/s", kNotNegative,
            "Standard deviation of a reading of the speed");
  table.add("sigma_steering", control.sigma_steering, "rad", kNotNegative,
            "Standard deviation of a reading of the steering");
}

void describeRobot(ParameterTable& table, Scenario& scenario) {
  LaserModel& laser = scenario.laser;
  OdometryModel& odometry = scenario.odometry;
  table.add("beams", laser.beams, "", {2, 100000}, "Beams of a scan");
  table.add("aperture", laser.aperture, "rad", {0.01, 2 * kPi}, "Angle between the first beam and the last");
  table.add("max_range", laser.max_range, "m", {0.1, 1000}, "Beams that hit nothing nearer are invalid");
  table.add("sigma_range", laser.sigma_range, "m", kNotNegative, "Standard deviation of a range");
  table.add("range_step", laser.range_step, "m", kNotNegative,
            "Ranges are multiples of this; 0: not rounded");
  table.add("odometry_along", odometry.along, "m/√m", kNotNegative, "Odometry noise along the motion");
  table.add("odometry_lateral", odometry.lateral, "m/√m", kNotNegative, "Odometry noise across the motion");
  table.add("odometry_turn_by_distance", odometry.turn_by_distance, "rad/√m", kNotNegative,
            "Noise of the heading from driving");
  table.add("odometry_turn_by_turn", odometry.turn_by_turn, "rad/√rad", kNotNegative,
            "Noise of the heading from turning");
  table.add("odometry_fixed_xy", odometry.fixed_xy, "m", kNotNegative,
            "Noise of each axis at every odometry_fixed_every-th scan, moving or not");
  table.add("odometry_fixed_turn", odometry.fixed_turn, "rad", kNotNegative, "The same of the heading");
  table.add("odometry_fixed_every", odometry.fixed_every, "", {1, 1000000}, "See odometry_fixed_xy");
  table.add("odometry_distance_scale", odometry.distance_scale, "", {0, 100}, "Measured / true distance");
  table.add("odometry_turn_scale", odometry.turn_scale, "", {0, 100}, "Measured / true turn");
}

}  // namespace

std::vector<std::string> scenarioNames() {
  std::vector<std::string> names = worldNames();
  for (const auto& road : roadNames()) names.push_back(road);
  return names;
}

Scenario makeScenario(const std::string& world) {
  const auto roads = roadNames();
  if (std::find(roads.begin(), roads.end(), world) != roads.end()) return drivingScenario(world);
  const auto worlds = worldNames();
  if (std::find(worlds.begin(), worlds.end(), world) == worlds.end())
    throw ConfigError(
        fmt::format("unknown world '{}': expected one of {}", world, fmt::join(scenarioNames(), ", ")));
  if (world == "non_convex") return publishedScenario(nonConvexWorld(), 0.94, 3640, 117);
  if (world == "long_corridors") return publishedScenario(longCorridorsWorld(), 1.15, 2680, 83);
  Scenario scenario;
  scenario.world = makeWorld(world);
  if (world == "floor") {
    scenario.drive.max_speed = 1.0;
    scenario.scan_rate = 10;
    scenario.laser = wideLaser();
  }
  return scenario;
}

void describe(ParameterTable& table, Scenario& scenario) {
  table.section("simulation", "How a log is simulated; the defaults belong to the world");
  describeDrive(table, scenario);
  if (scenario.hasLandmarks())
    describeCar(table, scenario);
  else
    describeRobot(table, scenario);
}

SimulatedLog simulate(const Scenario& scenario, uint64_t seed) {
  const std::size_t per_scan =
      scenario.hasLandmarks() ? static_cast<std::size_t>(scenario.control.readings_per_scan) : 1;
  Path path = drive(scenario.world.route, scenario.drive, scenario.scan_rate * static_cast<double>(per_scan));
  const auto limit = static_cast<std::size_t>(scenario.max_scans);
  const auto landmarks =
      scenario.hasLandmarks() ? plantLandmarks(scenario.landmarks, path) : std::vector<TrueLandmark>{};
  if (limit > 0) path.poses.resize(std::min(path.poses.size(), (limit - 1) * per_scan + 1));
  if (scenario.hasLandmarks())
    return simulateLandmarks(landmarks, path, scenario.landmark_sensor, scenario.control, seed);
  return simulate(scenario.world, path, scenario.laser, scenario.odometry, seed);
}

}  // namespace submap_slam
