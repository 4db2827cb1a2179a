/** Motion and measurement of a planar robot, with the Jacobians that filters need. */
#pragma once

#include <submap_slam/core/frame.h>

#include <Eigen/Core>

namespace submap_slam::landmark_mapping {

using Pose = Eigen::Vector3d;   ///< x, y (m), φ (rad)
using Point = Eigen::Vector2d;  ///< x, y (m)

/** The angle in (−π, π]. */
double wrapped(double angle);

Pose toPose(const mrpt::math::TPose2D& pose);

/** a ∘ b with ∂/∂a and ∂/∂b. The heading is not wrapped. */
struct Composition {
  Pose pose;
  Eigen::Matrix3d by_a, by_b;
};
Composition compose(const Pose& a, const Pose& b);

/** A measurement z = (range, bearing) with its covariance (m, rad). */
struct RangeBearing {
  Eigen::Vector2d z;
  Eigen::Matrix2d noise;
};

/** A feature as a sensor at T_robot_sensor measures it from a pose of the robot. */
struct Predicted {
  Eigen::Vector2d z;                    ///< range, bearing
  Eigen::Matrix<double, 2, 3> by_pose;  ///< ∂z/∂(x, y, φ) of the robot
  Eigen::Matrix2d by_feature;           ///< ∂z/∂(x, y) of the feature
};
Predicted predictMeasurement(const Pose& robot, const Pose& T_robot_sensor, const Point& feature);

/** The same for a sensor whose pose is known already. @param sensor compose(robot, T_robot_sensor) */
Predicted predictMeasurement(const Composition& sensor, const Point& feature);

/** Where a measured feature is, the inverse of predictMeasurement(). */
struct Located {
  Point feature;
  Eigen::Matrix<double, 2, 3> by_pose;
  Eigen::Matrix2d by_measurement;
};
Located locate(const Pose& robot, const Pose& T_robot_sensor, const Eigen::Vector2d& z);
Located locate(const Composition& sensor, const Eigen::Vector2d& z);

/** z − ẑ with the bearing wrapped. */
Eigen::Vector2d innovationOf(const Eigen::Vector2d& z, const Eigen::Vector2d& predicted);

}  // namespace submap_slam::landmark_mapping
