#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/eval/timed_trajectory.h>

#include <algorithm>
#include <cmath>

#include "table_file.h"

namespace submap_slam {
namespace {

std::vector<TimedPose> toTimedPoses(const Trajectory& trajectory) {
  std::vector<TimedPose> poses;
  poses.reserve(trajectory.size());
  for (const auto& p : trajectory) poses.push_back({mrpt::Clock::toDouble(p.stamp), toPose3D(p.pose)});
  return poses;
}

Pose3D interpolate(const Pose3D& a, const Pose3D& b, double u) {
  return {(1 - u) * a.translation + u * b.translation, a.rotation.slerp(u, b.rotation)};
}

TimedPose toTimedPose(const TableRow& row, const std::string& file) {
  const auto& v = row.values;
  const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
  constexpr double kZeroNorm = 1e-12;
  if (q.norm() < kZeroNorm) throw InputError(fmt::format("{}:{}: the quaternion is zero", file, row.line));
  return {v[0], {{v[1], v[2], v[3]}, q.normalized()}};
}

}  // namespace

Pose3D Pose3D::inverse() const {
  const Eigen::Quaterniond q = rotation.conjugate();
  return {-(q * translation), q};
}

Pose3D Pose3D::operator*(const Pose3D& T_b_c) const {
  return {translation + rotation * T_b_c.translation, (rotation * T_b_c.rotation).normalized()};
}

double Pose3D::angle() const { return 2 * std::atan2(rotation.vec().norm(), std::abs(rotation.w())); }

Pose3D poseFromRpy(double x, double y, double z, double roll, double pitch, double yaw) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return {{x, y, z},
          AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
              AngleAxisd(roll, Vector3d::UnitX())};
}

Pose3D toPose3D(const mrpt::math::TPose2D& pose) { return poseFromRpy(pose.x, pose.y, 0, 0, 0, pose.phi); }

mrpt::math::TPose2D toPose2D(const Pose3D& pose) {
  const Eigen::Vector3d ahead = pose.rotation * Eigen::Vector3d::UnitX();
  return {pose.translation.x(), pose.translation.y(), std::atan2(ahead.y(), ahead.x())};
}

TimedTrajectory::TimedTrajectory(const std::vector<TimedPose>& poses) : poses_(poses) {
  // Sorted from the back, so that unique() keeps the last pose given for a time.
  std::reverse(poses_.begin(), poses_.end());
  std::stable_sort(poses_.begin(), poses_.end(),
                   [](const TimedPose& a, const TimedPose& b) { return a.t < b.t; });
  const auto end = std::unique(poses_.begin(), poses_.end(),
                               [](const TimedPose& a, const TimedPose& b) { return a.t == b.t; });
  poses_.erase(end, poses_.end());
}

TimedTrajectory::TimedTrajectory(const Trajectory& trajectory) : TimedTrajectory(toTimedPoses(trajectory)) {}

std::optional<Pose3D> TimedTrajectory::at(double t, double tolerance, double max_gap) const {
  const auto after = std::lower_bound(poses_.begin(), poses_.end(), t,
                                      [](const TimedPose& p, double time) { return p.t < time; });
  const bool has_after = after != poses_.end(), has_before = after != poses_.begin();
  const double to_after = has_after ? after->t - t : std::numeric_limits<double>::infinity();
  const double to_before = has_before ? t - std::prev(after)->t : std::numeric_limits<double>::infinity();
  if (std::min(to_after, to_before) <= tolerance)
    return to_after < to_before ? after->pose : std::prev(after)->pose;
  if (!has_after || !has_before) return {};
  const TimedPose& before = *std::prev(after);
  const double gap = after->t - before.t;
  if (gap > max_gap) return {};
  return interpolate(before.pose, after->pose, to_before / gap);
}

TimedTrajectory readTum(const std::string& file) {
  std::vector<TimedPose> poses;
  for (const auto& row : readTable(file, "t x y z qx qy qz qw")) poses.push_back(toTimedPose(row, file));
  return TimedTrajectory(poses);
}

}  // namespace submap_slam
