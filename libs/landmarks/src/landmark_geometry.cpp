#include <submap_slam/landmarks/landmark_geometry.h>

#include <algorithm>
#include <cmath>

namespace submap_slam::landmark_mapping {
namespace {

/** Nearer to the sensor the bearing of a feature says nothing (m). */
constexpr double kLeastRange = 1e-3;

}  // namespace

double wrapped(double angle) {
  if (angle > -M_PI && angle <= M_PI) return angle;  // nearly always, and a remainder takes its time
  angle = std::remainder(angle, 2 * M_PI);
  return angle <= -M_PI ? M_PI : angle;
}

Pose toPose(const mrpt::math::TPose2D& pose) { return {pose.x, pose.y, pose.phi}; }

Composition compose(const Pose& a, const Pose& b) {
  const double c = std::cos(a[2]), s = std::sin(a[2]);
  const Point moved(c * b[0] - s * b[1], s * b[0] + c * b[1]);
  Composition out;
  out.pose << a[0] + moved.x(), a[1] + moved.y(), a[2] + b[2];
  out.by_a << 1, 0, -moved.y(), 0, 1, moved.x(), 0, 0, 1;
  out.by_b << c, -s, 0, s, c, 0, 0, 0, 1;
  return out;
}

Predicted predictMeasurement(const Pose& robot, const Pose& T_robot_sensor, const Point& feature) {
  return predictMeasurement(compose(robot, T_robot_sensor), feature);
}

Predicted predictMeasurement(const Composition& sensor, const Point& feature) {
  const Point d = feature - sensor.pose.head<2>();
  const double r = std::max(d.norm(), kLeastRange);
  Predicted out;
  out.z << r, wrapped(std::atan2(d.y(), d.x()) - sensor.pose[2]);
  out.by_feature << d.x() / r, d.y() / r, -d.y() / (r * r), d.x() / (r * r);
  // Through the sensor's position, which turns with the robot, and for the bearing through its heading.
  out.by_pose = -out.by_feature * sensor.by_a.topRows<2>();
  out.by_pose(1, 2) -= 1;
  return out;
}

Located locate(const Pose& robot, const Pose& T_robot_sensor, const Eigen::Vector2d& z) {
  return locate(compose(robot, T_robot_sensor), z);
}

Located locate(const Composition& sensor, const Eigen::Vector2d& z) {
  const double angle = sensor.pose[2] + z[1], c = std::cos(angle), s = std::sin(angle);
  const Point ray(z[0] * c, z[0] * s), turned(-ray.y(), ray.x());
  Located out;
  out.feature = sensor.pose.head<2>() + ray;
  out.by_pose = sensor.by_a.topRows<2>();
  out.by_pose.col(2) += turned;
  out.by_measurement << c, turned.x(), s, turned.y();
  return out;
}

Eigen::Vector2d innovationOf(const Eigen::Vector2d& z, const Eigen::Vector2d& predicted) {
  return {z[0] - predicted[0], wrapped(z[1] - predicted[1])};
}

}  // namespace submap_slam::landmark_mapping
