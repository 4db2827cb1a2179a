#pragma once

#include <submap_slam/core/grid_submap.h>
#include <submap_slam/core/local_mapper.h>
#include <submap_slam/landmarks/landmark_filter.h>

#include <vector>

namespace submap_slam::landmark_mapping {

/** Motion between consecutive frames. */
class OdometrySteps {
 public:
  explicit OdometrySteps(const LandmarkMotionParams& params) : params_(params) {}

  /** By odometry, with the covariance that the frame brings or that of the parameters. Where odometry is
   * missing the robot goes on as in the step before, with a wide covariance. */
  MotionStep between(const Frame& before, const Frame& now);

 private:
  Eigen::Matrix3d covarianceOf(const Pose& increment) const;

  LandmarkMotionParams params_;
  Pose last_ = Pose::Zero();
};

/** The frames of a grid submap, and the one where it ends if it has a successor, with the grid's path in the
 * place of odometry. The covariance of its end is spread over the steps by their length.
 * @param first position of the submap's first frame in the stretch */
std::vector<Frame> framesAlong(const Stretch& stretch, std::size_t first, const GridSubmap& grid);

}  // namespace submap_slam::landmark_mapping
