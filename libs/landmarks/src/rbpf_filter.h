#pragma once

#include <submap_slam/landmarks/feature_association.h>
#include <submap_slam/landmarks/feature_map.h>
#include <submap_slam/landmarks/landmark_filter.h>
#include <submap_slam/landmarks/mixture.h>

#include <random>
#include <tuple>
#include <utility>
#include <vector>

namespace submap_slam::landmark_mapping {

/** Rao-Blackwellized particle filter (Montemerlo, Thrun, FastSLAM 1 and 2): particles are paths, and given
 * its path a particle has a small Kalman filter for each feature.
 *
 * Between scans a particle holds a Gaussian of the pose; it is sampled when there are measurements: before
 * them (FastSLAM 1), or from its product with their likelihood (FastSLAM 2), so that nothing is lost where
 * nothing is measured. Each particle associates by itself.
 *
 * A few dozen particles say well which measurement is of which feature, but not how certain the path is:
 * drawn anew, they soon have their first poses in common, and nothing that comes later corrects these. For
 * the estimate particles therefore stand for their associations alone: given the association, path and
 * features are smoothed by least squares. The estimate is the paper's mixture of particles where the
 * parameters ask for it, in a single map of the whole log, and where smoothing the heaviest association
 * fails.
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
  /** A measurement, and the feature that it was taken for. */
  struct Seen {
    std::size_t scan = 0, measurement = 0;
    uint32_t feature = 0;
    bool operator<(const Seen& o) const {
      return std::tie(scan, measurement, feature) < std::tie(o.scan, o.measurement, o.feature);
    }
  };
  struct PathNode {
    Pose pose;
    std::size_t before;
    std::vector<Seen> seen;
  };
  struct RecordedScan {
    std::size_t step = 0;
    MeasuredScan scan;
  };
  struct Mixture {
    std::vector<MixtureComponent> components;
    std::vector<std::vector<Pose>> paths;
  };
  struct Match {
    std::size_t measurement = 0;
    FeatureMap::Place place;
  };

  void observe(Particle& particle, const MeasuredScan& scan);
  static std::vector<Match> matchesAt(const std::vector<FeatureMap::Place>& places,
                                      const std::vector<std::pair<std::size_t, std::size_t>>& found);
  std::vector<Pairing> pairingsOf(const Particle& particle, const MeasuredScan& scan,
                                  const std::vector<FeatureMap::Place>& places,
                                  const std::vector<Origin>& origins) const;
  std::vector<FeatureMap::Place> visible(const Particle& particle, const MeasuredScan& scan) const;
  void take(Particle& particle, const MeasuredScan& scan, const std::vector<Match>& matches) const;
  void improveProposal(Particle& particle, const MeasuredScan& scan, const std::vector<Match>& matches) const;
  void samplePose(Particle& particle);
  void weigh(Particle& particle, const MeasuredScan& scan, const std::vector<Match>& matches) const;
  void updateFeatures(Particle& particle, const MeasuredScan& scan, const Composition& sensor,
                      const std::vector<Match>& matches, const std::vector<FeatureMap::Place>& places) const;
  std::vector<FeatureMap::Place> missed(const Particle& particle, const MeasuredScan& scan,
                                        const Composition& sensor, const std::vector<Match>& matches,
                                        const std::vector<FeatureMap::Place>& places) const;
  void addNew(Particle& particle, const MeasuredScan& scan, const Composition& sensor,
              const std::vector<Origin>& origins);
  void normalise();
  double effective() const;
  void resample();
  std::vector<Pose> pathOf(const Particle& particle) const;
  static std::vector<Feature> featuresOf(const Particle& particle);
  std::vector<Seen> associationOf(const Particle& particle) const;
  Mixture mixtureOfParticles() const;
  Mixture mixtureOfAssociations() const;
  bool addSmoothed(const Particle& particle, const std::vector<Seen>& association, double weight,
                   Mixture& mixture) const;
  void noteOrigins(Particle& particle, const MeasuredScan& scan, const std::vector<Origin>& origins,
                   const std::vector<FeatureMap::Place>& places);
  void note(const Particle& particle, std::size_t measurement, uint32_t feature);
  const Particle& best() const;

  LandmarkAssociationParams association_;
  LandmarkParticleParams params_;
  bool improved_proposal_;
  bool smooths_;  ///< not a whole log: what that takes has no bound
  std::mt19937_64 random_;
  std::vector<Particle> particles_;
  std::vector<PathNode> nodes_;
  std::vector<MotionStep> steps_;
  std::vector<RecordedScan> scans_;
  bool depleted_ = false;
};

}  // namespace submap_slam::landmark_mapping
