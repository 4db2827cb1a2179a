#pragma once

#include <submap_slam/core/landmark_submap.h>
#include <submap_slam/landmarks/landmark_geometry.h>
#include <submap_slam/landmarks/landmark_mapper_params.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace submap_slam::landmark_mapping {

/** What odometry says of one step. */
struct MotionStep {
  Pose increment;              ///< T_before_now
  Eigen::Matrix3d covariance;  ///< in the frame before
};

/** A measurement that a filter takes, with the noise of its sensor. */
struct Measurement {
  RangeBearing value;
  std::optional<uint32_t> known_id;
  uint32_t index = 0;  ///< among all of the submap, from 1
};

/** A scan as filters take it. */
struct MeasuredScan {
  Pose T_robot_sensor;
  double max_range = 0;      ///< m; 0: not known
  double field_of_view = 0;  ///< rad; 0: not known
  std::vector<Measurement> measurements;
};

/** Features and end pose as a Gaussian, in the frame of the start pose. */
struct LandmarkEstimate {
  std::vector<SubmapFeature> features;
  Pose pose = Pose::Zero();
  Eigen::MatrixXd covariance;  ///< of (x, y, φ, x_1, y_1, …)
  std::vector<Pose> path;      ///< pose after each step, the first one 0
};

/** A local filter: the pose of the robot and the features around it, from a pose that is exactly 0. */
class LandmarkFilter {
 public:
  virtual ~LandmarkFilter() = default;

  virtual void predict(const MotionStep& step) = 0;
  virtual void observe(const MeasuredScan& scan) = 0;

  /** Covariance of the pose now. */
  virtual Eigen::Matrix3d poseCovariance() const = 0;
  virtual std::size_t features() const = 0;

  /** True if the last scan left too little diversity to go on with. */
  virtual bool depleted() const { return false; }

  virtual LandmarkEstimate estimate() const = 0;
};

/** The filter that `method` names. @param seed of its random stream */
std::unique_ptr<LandmarkFilter> makeLandmarkFilter(const LandmarkMapperParams& params, uint64_t seed);

/** The measurements of a scan with their noise. Left out are those that are not finite or not in front of the
 * sensor, and those with an id that the scan has twice, as they contradict each other.
 * @param measurements_so_far of the submap, is raised by those of the scan */
MeasuredScan usableMeasurements(const LandmarkScan& scan, const LandmarkMapperParams& params,
                                uint32_t& measurements_so_far);

}  // namespace submap_slam::landmark_mapping
