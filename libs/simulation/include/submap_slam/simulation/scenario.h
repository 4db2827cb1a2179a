#pragma once

#include <submap_slam/core/parameters.h>
#include <submap_slam/simulation/landmarks.h>
#include <submap_slam/simulation/simulate.h>

#include <cstdint>
#include <string>
#include <vector>

namespace submap_slam {

/** Everything that a simulated log depends on besides the seed: either a robot with a laser between walls, or
 * a car with a sensor for landmarks. */
struct Scenario {
  World world;
  DriveLimits drive;
  double scan_rate = 5;  ///< Hz
  int max_scans = 0;     ///< the log ends after this many scans; 0: at the end of the route
  LaserModel laser;
  OdometryModel odometry;

  // of a car
  LandmarkField landmarks;
  LandmarkSensor landmark_sensor;
  ControlModel control;

  bool hasLandmarks() const { return landmarks.count > 0; }
};

/** Names that makeScenario() knows: those of worlds and of roads. */
std::vector<std::string> scenarioNames();

/** The scenario of that world or road with its usual sensors; throws ConfigError for a name that
 * scenarioNames() does not list.
 *
 * `non_convex` and `long_corridors` are drawn after the two simulations of Wang, Zhao, Huang, "Grid-based
 * Submap Joining" (2025): 1081 beams over 270° with σ = 0.02 m; 3640 scans in 117 s and 2680 in 83 s.
 * Odometry has errors of 0.04 m and 0.003 rad at every fourth scan: at every scan it would drift three times
 * as far as published.
 *
 * `landmarks_a` and `landmarks_b` are made after the simulation of the Combined SLAM paper (Huang, Wang,
 * Dissanayake et al.): 3 m/s, controls at 40 Hz with σ = 0.3 m/s and 3°, observations at 5 Hz over 180° and
 * 30 m with σ = 0.5 m and 5°, 554 landmarks. The 3° are taken as those of the steering of a bicycle with 4 m
 * wheel base, and landmarks stand within 28 m of the road: spread over the 2 km × 2 km of the paper they
 * would leave most scans empty. `landmarks_block` is short and has better sensors. */
Scenario makeScenario(const std::string& world);

/** Adds section [simulation], bound to all of the scenario's form but the world; its defaults are what the
 * scenario holds now. */
void describe(ParameterTable& table, Scenario& scenario);

/** Drives the robot along the route; throws ConfigError if a model holds an impossible value. */
SimulatedLog simulate(const Scenario& scenario, uint64_t seed);

}  // namespace submap_slam
