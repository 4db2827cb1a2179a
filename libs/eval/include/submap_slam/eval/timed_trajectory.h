#pragma once

#include <submap_slam/core/joined_map.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace submap_slam {

/** A rigid transform in 3D (m). */
struct Pose3D {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  Pose3D inverse() const;

  /** T_a_c = T_a_b * T_b_c. */
  Pose3D operator*(const Pose3D& T_b_c) const;

  /** Rotation angle in [0, π] (rad). */
  double angle() const;
};

/** From roll, pitch and yaw: R = Rz(yaw) Ry(pitch) Rx(roll) (m, rad). */
Pose3D poseFromRpy(double x, double y, double z, double roll, double pitch, double yaw);

/** A planar pose in 3D, and back: x, y and the heading of the x axis. */
Pose3D toPose3D(const mrpt::math::TPose2D& pose);
mrpt::math::TPose2D toPose2D(const Pose3D& pose);

struct TimedPose {
  double t = 0;  ///< s, since 1970 in real logs
  Pose3D pose;   ///< T_w_robot
};

/** Poses sorted by time, each time once. */
class TimedTrajectory {
 public:
  TimedTrajectory() = default;

  /** Any order; of several poses at the same time the last one stands. */
  explicit TimedTrajectory(const std::vector<TimedPose>& poses);
  explicit TimedTrajectory(const Trajectory& trajectory);

  const std::vector<TimedPose>& poses() const { return poses_; }

  static constexpr double kTolerance_s = 1e-3;  ///< for stamps that were rounded

  /** The pose at time t (s): the nearest one if it is within `tolerance` s, else interpolated (slerp for the
   * rotation) between its two neighbours if these are at most `max_gap` s apart; nothing before the first and
   * after the last pose. */
  std::optional<Pose3D> at(double t, double tolerance = kTolerance_s, double max_gap = 5) const;

 private:
  std::vector<TimedPose> poses_;
};

/** Reads a TUM file: `t x y z qx qy qz qw` in each line, blanks or commas between, `#` starts a comment.
 * Throws InputError naming file and line; a file without poses is an error. */
TimedTrajectory readTum(const std::string& file);

}  // namespace submap_slam
