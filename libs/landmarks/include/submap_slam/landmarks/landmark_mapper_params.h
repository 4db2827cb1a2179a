#pragma once

#include <submap_slam/core/parameters.h>

#include <string>

namespace submap_slam {

/** Noise of odometry over one step, where the log's reader does not say it (Frame::motion_covariance). */
struct LandmarkMotionParams {
  double sigma_xy = 0.01;           ///< m
  double sigma_xy_per_m = 0.05;     ///< m per m
  double sigma_phi = 0.002;         ///< rad
  double sigma_phi_per_m = 0.01;    ///< rad per m
  double sigma_phi_per_rad = 0.05;  ///< rad per rad
};

/** Noise of the landmark sensor; 0: what the log says of it, or 0.1 m + 1 % of the range and 1° if it says
 * nothing. */
struct LandmarkSensorParams {
  double sigma_range = 0;        ///< m
  double sigma_range_per_m = 0;  ///< m per m of range, on top of sigma_range
  double sigma_bearing = 0;      ///< rad
};

/** Which measurement is of which feature. */
struct LandmarkAssociationParams {
  bool known_ids = true;     ///< ids in the log are believed
  double match_gate = 9.21;  ///< largest squared distance of a match (χ², 2 degrees of freedom: 99 %)
  double new_gate = 20;      ///< a measurement farther from every feature is of a new one
  int min_hits = 3;          ///< features seen less often are left out of a submap; not where ids are known
};

/** Rao-Blackwellized particle filter. */
struct LandmarkParticleParams {
  std::string proposal = "fastslam2";
  int particles = 60;
  double resample_below = 0.5;        ///< share of N_eff
  double seen = 1.0, missed = 0.1;    ///< evidence for and against a feature, log-odds
  std::string gaussian = "smoothed";  ///< or "particles"
};

/** When the filter closes a submap before the stretch ends. */
struct LandmarkClosingParams {
  double max_pose_sigma = 5;  ///< of the pose, in sigmas of the sensor
  int depleted_scans = 20;    ///< scans in a row that need resampling
  int max_features = 60;
  double min_distance = 0.5;  ///< m
};

struct LandmarkMapperParams {
  std::string method = "ekf";  ///< or "rbpf"
  bool single_map = false;
  double max_distance = 30;  ///< m of odometry
  LandmarkMotionParams motion;
  LandmarkSensorParams sensor;
  LandmarkAssociationParams association;
  LandmarkParticleParams particles;
  LandmarkClosingParams closing;
};

/** Adds the section [landmark_mapper]. */
void describe(ParameterTable& table, LandmarkMapperParams& params);

}  // namespace submap_slam
