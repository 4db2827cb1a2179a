#pragma once

#include <submap_slam/core/parameters.h>
#include <submap_slam/simulation/simulate.h>

#include <cstdint>
#include <string>

namespace submap_slam {

/** Everything that a simulated log depends on besides the seed. */
struct Scenario {
  World world;
  DriveLimits drive;
  double scan_rate = 5;  ///< Hz
  int max_scans = 0;     ///< the log ends after this many scans; 0: at the end of the route
  LaserModel laser;
  OdometryModel odometry;
};

/** The scenario of that world with its usual sensors; throws ConfigError for a name that worldNames() does
 * not list.
 *
 * `non_convex` and `long_corridors` are drawn after the two simulations of Wang, Zhao, Huang, "Grid-based
 * Submap Joining" (2025): 1081 beams over 270° with σ = 0.02 m; 3640 scans in 117 s and 2680 in 83 s.
 * Odometry has errors of 0.04 m and 0.003 rad at every fourth scan: at every scan it would drift three times
 * as far as published. */
Scenario makeScenario(const std::string& world);

/** Adds section [simulation], bound to all but the world; its defaults are what the scenario holds now. */
void describe(ParameterTable& table, Scenario& scenario);

/** Drives the robot along the route; throws ConfigError if a model holds an impossible value. */
SimulatedLog simulate(const Scenario& scenario, uint64_t seed);

}  // namespace submap_slam
