/** Landmarks beside a road, and a car with a sensor that knows them. */
#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/vehicle_model.h>
#include <submap_slam/simulation/path.h>
#include <submap_slam/simulation/simulate.h>

#include <cstdint>
#include <string>
#include <vector>

namespace submap_slam {

/** Landmarks at random places beside a path. */
struct LandmarkField {
  int count = 0;       ///< 0: a world of walls
  double spread = 28;  ///< they are at most so far (m) to either side of the path
  int place_seed = 1;  ///< seed of the places, which do not depend on the seed of the noise
};

/** The landmarks of a field, with ids from 1. */
std::vector<TrueLandmark> plantLandmarks(const LandmarkField& field, const Path& path);

/** A car with the geometry of a bicycle: its heading changes with v tan(steering) / wheel_base. Speed and
 * steering are measured with noise that is independent at each reading. */
struct ControlModel {
  double wheel_base = 4;                        ///< m
  double sigma_velocity = 0.3;                  ///< m/s
  double sigma_steering = 0.05235987755982988;  ///< rad
  int readings_per_scan = 8;                    ///< at least 1
};

/** What a mapper should know of the car: a bicycle with this noise of its readings, and no other. */
VehicleParams vehicleOf(const ControlModel& control);

/** Measures range and bearing of all landmarks in its field of view, and tells which they are. */
struct LandmarkSensor {
  double max_range = 30;                       ///< m
  double field_of_view = 3.141592653589793;    ///< rad, symmetric to the heading
  double sigma_range = 0.5;                    ///< m
  double sigma_bearing = 0.08726646259971647;  ///< rad
};

/** Throw ConfigError naming the member that holds an impossible value. */
void validate(const LandmarkField& field);
void validate(const ControlModel& control);
void validate(const LandmarkSensor& sensor);

/** Drives a car along a path with one pose for each reading of its controls, and a scan for landmarks at the
 * first pose and at every `readings_per_scan`-th after it.
 *
 * Reading k has the stamp 2020-01-01 00:00 UTC + k · period and tells the velocities until reading k + 1, and
 * the pose that they add up to, from the identity. Controls and sensor have random streams of their own. The
 * same arguments give the same log, bit for bit; odometry is rounded to 1 µm and 1 µrad (and per second).
 * Throws ConfigError if a model holds an impossible value, the path is empty, or the car would have to turn
 * on the spot. */
SimulatedLog simulateLandmarks(const std::vector<TrueLandmark>& landmarks, const Path& path,
                               const LandmarkSensor& sensor, const ControlModel& control, uint64_t seed);

/** A route for a car, in a world without walls. */
struct Road {
  std::string name;
  WayPoints route;
};

/** Names that makeRoad() knows: landmarks_a, landmarks_b, landmarks_block. */
std::vector<std::string> roadNames();

/** The road of that name; throws ConfigError, listing the names there are, for any other.
 *
 * `landmarks_a` is one round of 6.4 km and 300 m of the next one, `landmarks_b` two rounds of 3.2 km,
 * `landmarks_block` one and a bit around a block of 0.3 km. */
Road makeRoad(const std::string& name);

}  // namespace submap_slam
