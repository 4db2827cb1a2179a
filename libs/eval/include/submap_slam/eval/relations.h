/** Relative-pose error of a trajectory against known relations between instants (Kümmerle et al., "On
 * measuring the accuracy of SLAM algorithms", Autonomous Robots 27(4), 2009). It needs no common global
 * frame. */
#pragma once

#include <submap_slam/eval/error_statistics.h>
#include <submap_slam/eval/timed_trajectory.h>

#include <limits>
#include <string>
#include <vector>

namespace submap_slam {

/** Where the robot was at t2 seen from where it was at t1 (s). */
struct Relation {
  double t1 = 0, t2 = 0;
  Pose3D T_1_2;
};

/** Reads a `.relations` file: `t1 t2 x y z roll pitch yaw` in each line (s, m, rad), `#` starts a comment.
 * Throws InputError naming file and line; a file without relations is an error. */
std::vector<Relation> readRelations(const std::string& file);

struct RelationsOptions {
  double tolerance_s = 1e-3;  ///< stamps closer than this are equal
  double max_gap_s = 5;       ///< longest gap between poses that is interpolated
  double min_dt_s = 0;        ///< only relations with |t2 − t1| in [min_dt_s, max_dt_s]
  double max_dt_s = std::numeric_limits<double>::infinity();
};

struct RelationsResult {
  std::size_t total = 0;     ///< relations given
  std::size_t used = 0;      ///< evaluated
  std::size_t skipped = 0;   ///< no pose at one of its instants
  std::size_t filtered = 0;  ///< outside of [min_dt_s, max_dt_s]
  ErrorStatistics translation_m, rotation_deg;
};

/** For each relation δ* and estimate δ = T_w_1⁻¹ T_w_2 the error is δ*⁻¹ δ: its length (m) and rotation angle
 * (deg). */
RelationsResult evaluateRelations(const std::vector<Relation>& relations, const TimedTrajectory& trajectory,
                                  const RelationsOptions& options = {});

/** All relations, and apart the local (|t2 − t1| ≤ split) and the global ones (> split; loop closures). */
struct RelationsReport {
  double split_s = 60;
  RelationsResult all, local, global;
};
RelationsReport evaluateRelationsSplit(const std::vector<Relation>& relations,
                                       const TimedTrajectory& trajectory, double split_s = 60);

/** A table for people with the three rows of the report. */
std::string formatTable(const RelationsReport& report);

}  // namespace submap_slam
