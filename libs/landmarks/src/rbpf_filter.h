#pragma once

#include <submap_slam/landmarks/feature_association.h>
#include <submap_slam/landmarks/feature_map.h>
#include <submap_slam/landmarks/landmark_filter.h>
#include <submap_slam/landmarks/mixture.h>

#include <random>
#include <utility>
#include <vector>

namespace submap_slam::landmark_mapping {

/** Rao-Blackwellized particle filter (Montemerlo, Thrun, FastSLAM 1 and 2): particles are paths, and given
 * its path a particle has a small Kalman filter for each feature.
 *
 * Between scans a particle holds a Gaussian of the pose; it is sampled when there are measurements: before
 * them (FastSLAM 1), or from its product with their likelihood (FastSLAM 2), so that nothing is lost where
 * nothing is measured. Each particle associates by itself.
 */
class RbpfFilter : public LandmarkFilter {
 public:
  RbpfFilter(const LandmarkMapperParams& params, uint64_t seed);

  void predict(const MotionStep& step) override;
  void observe(const MeasuredScan& scan) override;
  Eigen::Matrix3d poseCovariance() const override;
  std::size_t features() const override;
  bool depleted() const override { return depleted_; }
  LandmarkEstimate estimate() const override;

 private:
  struct Particle {
    Pose pose = Pose::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the pose, as far as it is not sampled
    double log_weight = 0;
    FeatureMap features;
    std::size_t path = 0;  ///< last node
  };
  struct PathNode {
    Pose pose;
    std::size_t before;
  };
  struct Match {
    std::size_t measurement = 0;
    FeatureMap::Place place;
  };

  void observe(Particle& particle, const MeasuredScan& scan);
  std::vector<Origin> associate(const Particle& particle, const MeasuredScan& scan,
                                const std::vector<FeatureMap::Place>& places) const;
  std::vector<FeatureMap::Place> visible(const Particle& particle, const MeasuredScan& scan) const;
  void improveProposal(Particle& particle, const MeasuredScan& scan, const std::vector<Match>& matches) const;
  void samplePose(Particle& particle);
  void weigh(Particle& particle, const MeasuredScan& scan, const std::vector<Match>& matches) const;
  void updateFeatures(Particle& particle, const MeasuredScan& scan, const std::vector<Match>& matches,
                      const std::vector<FeatureMap::Place>& places) const;
  void addNew(Particle& particle, const MeasuredScan& scan, const std::vector<Origin>& origins) const;
  void normalise();
  double effective() const;
  void resample();
  std::vector<Pose> pathOf(const Particle& particle) const;
  std::vector<Pose> meanPath(const std::vector<std::size_t>& kept) const;
  const Particle& best() const;

  LandmarkAssociationParams association_;
  LandmarkParticleParams params_;
  bool improved_proposal_;
  std::mt19937_64 random_;
  std::vector<Particle> particles_;
  std::vector<PathNode> nodes_;
  bool depleted_ = false;
};

}  // namespace submap_slam::landmark_mapping
