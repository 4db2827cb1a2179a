#pragma once

#include <submap_slam/landmarks/landmark_filter.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace submap_slam::landmark_mapping {

/** A measurement of a feature from the pose after so many steps. */
struct Sighting {
  std::size_t step = 0;
  Pose T_robot_sensor;
  RangeBearing value;
  std::size_t feature = 0;  ///< features are counted in the order in which they are first seen
};

/** Poses and features of a submap given which measurement is of which feature. */
struct SmoothedSubmap {
  std::vector<Pose> path;  ///< the first one 0
  std::vector<Point> features;
  Eigen::MatrixXd covariance;  ///< of (x, y, φ) of the last pose, then x and y of each feature
};

/** Least squares over all poses and features at once (Gauss-Newton), so that every measurement corrects all
 * of the path and nothing of it is sampled. A pose is eliminated as soon as the next one is there: the effort
 * grows with the number of steps times the square of that of features.
 * @param steps the k-th leads from path[k] to path[k + 1]
 * @param sightings in the order of their steps
 * @param path where to begin
 * @return empty if it does not converge, or if the information is not positive definite */
std::optional<SmoothedSubmap> smoothSubmap(const std::vector<MotionStep>& steps,
                                           const std::vector<Sighting>& sightings, std::vector<Pose> path);

}  // namespace submap_slam::landmark_mapping
