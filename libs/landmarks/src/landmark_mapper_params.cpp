#include <submap_slam/landmarks/landmark_mapper_params.h>

namespace submap_slam {
namespace {

constexpr Range kPositive{1e-9, 1e9};
constexpr Range kNonNegative{0, 1e9};

void describe(ParameterTable& table, LandmarkMotionParams& p) {
  table.add("sigma_xy", p.sigma_xy, "m", kNonNegative,
            "Standard deviation of odometry over a step with motion, unless the vehicle's model says it");
  table.add("sigma_xy_per_m", p.sigma_xy_per_m, "m/m", kNonNegative, "… for each metre moved");
  table.add("sigma_phi", p.sigma_phi, "rad", kNonNegative, "The same of the heading");
  table.add("sigma_phi_per_m", p.sigma_phi_per_m, "rad/m", kNonNegative, "… for each metre moved");
  table.add("sigma_phi_per_rad", p.sigma_phi_per_rad, "rad/rad", kNonNegative, "… for each radian turned");
}

void describe(ParameterTable& table, LandmarkSensorParams& p) {
  table.add("sigma_range", p.sigma_range, "m", kNonNegative,
            "Standard deviation of a measured range; 0: what the log says, or 0.1 m + 1 % of the range");
  table.add("sigma_range_per_m", p.sigma_range_per_m, "m/m", kNonNegative,
            "… for each metre of range, on top of a sigma_range that is not 0");
  table.add("sigma_bearing", p.sigma_bearing, "rad", kNonNegative,
            "Standard deviation of a measured bearing; 0: what the log says, or 1 degree");
}

void describe(ParameterTable& table, LandmarkAssociationParams& p) {
  table.add("known_ids", p.known_ids,
            "Ids of landmarks in the log are believed; false: measurements are matched by position");
  table.add("match_gate", p.match_gate, "", kPositive,
            "Largest squared Mahalanobis distance of a measurement from its feature");
  table.add("new_gate", p.new_gate, "", kPositive,
            "A measurement farther from every feature is of a new one; between the gates it is left out");
  table.add("min_hits", p.min_hits, "", {1, 1000},
            "Features that were measured less often are left out of the submap, unless their ids are known");
}

void describe(ParameterTable& table, LandmarkParticleParams& p) {
  table.add("proposal", p.proposal,
            "Where particles are drawn: from odometry (fastslam1), or from odometry and measurements",
            {"fastslam1", "fastslam2"});
  table.add("particles", p.particles, "", {1, 100000}, "Number of particles");
  table.add("resample_below", p.resample_below, "", {0, 1},
            "Particles are drawn anew when the effective number falls below this share");
  table.add("evidence_seen", p.seen, "", kNonNegative,
            "Log-odds that a measurement adds to the evidence for its feature");
  table.add(
      "evidence_missed", p.missed, "", kNonNegative,
      "Log-odds that a feature loses where the sensor looks at it and does not see it; below 0 it goes");
  table.add(
      "gaussian", p.gaussian,
      "How the submap is made of the particles: from their associations, with the path of each smoothed "
      "by least squares, or from their paths, as many as there are particles; always the latter with "
      "single_map, as smoothing a whole log takes too long",
      {"smoothed", "particles"});
}

void describe(ParameterTable& table, LandmarkClosingParams& p) {
  table.add("max_pose_sigma", p.max_pose_sigma, "", kPositive,
            "A submap ends when its pose is so many times less certain than the sensor is exact");
  table.add("depleted_scans", p.depleted_scans, "", {1, 1000000},
            "A submap ends when so many scans in a row left too few effective particles");
  table.add("max_features", p.max_features, "", {3, 2000}, "A submap ends when it has so many features");
  table.add("min_distance", p.min_distance, "m", kNonNegative,
            "These rules end no submap before so much motion: a robot that stands still stays in it");
}

}  // namespace

void describe(ParameterTable& table, LandmarkMapperParams& p) {
  table.section("landmark_mapper", "How landmark submaps are built from measured landmarks");
  table.add("method", p.method, "Particle filter (FastSLAM), or extended Kalman filter", {"rbpf", "ekf"});
  table.add("max_distance", p.max_distance, "m", {0.1, 1e9},
            "Odometry path after which the next submap begins, where only landmarks are mapped");
  table.add("single_map", p.single_map, "One submap for the whole log: the filter alone, for comparison");
  describe(table, p.motion);
  describe(table, p.sensor);
  describe(table, p.association);
  describe(table, p.particles);
  describe(table, p.closing);
}

}  // namespace submap_slam
