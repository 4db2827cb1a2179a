#pragma once

#include <submap_slam/core/frame.h>
#include <submap_slam/landmarks/landmark_filter.h>

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

}  // namespace submap_slam::landmark_mapping
