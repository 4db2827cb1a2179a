#pragma once

#include <submap_slam/landmarks/feature_association.h>
#include <submap_slam/landmarks/landmark_filter.h>

#include <vector>

namespace submap_slam::landmark_mapping {

/** Extended Kalman filter over the pose and all features with their joint covariance. */
class EkfFilter : public LandmarkFilter {
 public:
  explicit EkfFilter(const LandmarkMapperParams& params);

  void predict(const MotionStep& step) override;
  void observe(const MeasuredScan& scan) override;
  Eigen::Matrix3d poseCovariance() const override { return covariance_.topLeftCorner<3, 3>(); }
  std::size_t features() const override { return tracks_.size(); }
  LandmarkEstimate estimate() const override;

 private:
  struct Track {
    uint32_t id = 0;
    bool known = false;
    uint32_t hits = 1;
  };
  std::vector<Pairing> pairingsOf(const MeasuredScan& scan, const std::vector<Origin>& origins) const;
  std::vector<Pairing> pairingsOf(std::size_t measurement, const MeasuredScan& scan,
                                  const Composition& sensor) const;
  void update(const MeasuredScan& scan, const std::vector<std::pair<std::size_t, std::size_t>>& matches);
  void add(const Pose& T_robot_sensor, const Measurement& measurement);
  Pose pose() const { return mean_.head<3>(); }
  Point feature(std::size_t i) const { return mean_.segment<2>(row(i)); }
  static Eigen::Index row(std::size_t feature) { return 3 + 2 * static_cast<Eigen::Index>(feature); }

  LandmarkAssociationParams params_;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
  std::vector<Track> tracks_;
  std::vector<Pose> path_;
};

}  // namespace submap_slam::landmark_mapping
