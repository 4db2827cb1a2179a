#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/mapping/correlative_search.h>
#include <submap_slam/mapping/laser_points.h>
#include <submap_slam/mapping/local_path.h>
#include <submap_slam/mapping/scan_matcher.h>
#include <submap_slam/mapping/surfel_map.h>

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

namespace submap_slam {

struct FilterParams {
  SurfelMapParams map;
  MatcherParams matcher;
  CorrelativeSearchParams search;
  MotionParams motion;
  double rescue_below = 0.85;      ///< share of the inlier beams that are usual
  double slip_beyond = 5.0;        ///< sigmas
  double slip_cost = 10.0;         ///< negative log probability of a slip while odometry goes on evenly
  double surprise_cost = 2.0;      ///< the same where odometry says something quite different from before
  double slip_information = 0.02;  ///< share of the odometry's information that is left in a rescue
  KeyParams keys;
  int fixed_particles = 0;  ///< 0: adaptive
  int max_particles = 12;
  double resample_below = 0.5;    ///< share of N_eff
  double likelihood_power = 0.1;  ///< tempering
  double min_weight = 1e-3;
  double decided_weight = 0.98;
};

/** One hypothesis: a path and the map that follows from it. */
struct Particle {
  SurfelMap map;
  LocalPath path;
  double log_weight = 0;
};

/** Rao-Blackwellized particle filter over the path of the robot, with one matching map per particle.
 *
 * The proposal is the scan matcher's posterior (Grisetti, Stachniss, Burgard, T-RO 2007). With
 * `fixed_particles` > 0 it is the classical filter: sampling around the match, resampling when N_eff falls
 * below a threshold. Otherwise the number of particles adapts: one while the posterior has one mode, one for
 * each mode while it has several, one again when the weights have decided.
 */
class ParticleFilter {
 public:
  ParticleFilter(const FilterParams& params, uint64_t seed);

  /** Takes the next frame. @param increment T_previous_now by odometry; empty: constant velocity is assumed
   */
  void step(const LaserPoints& scan, const std::optional<mrpt::math::TPose2D>& increment);

  const Particle& best() const;
  std::size_t size() const { return particles_.size(); }

  /** 1 / Σ w², w the normalised weights. */
  double effectiveParticles() const;

  uint32_t rescues() const { return rescues_; }
  uint32_t resamplings() const { return resamplings_; }

 private:
  struct Proposal {
    MatchResult match;
    double log_weight = 0;    ///< to be added to the particle's
    bool by_odometry = true;  ///< see PathNode
  };
  std::vector<Proposal> propose(const Particle& particle, const LaserPoints& scan, const PosePrior& prior);
  /** True if odometry says something quite different from the motion before: wheels that start to slip. */
  bool isSurprising(const Particle& particle, const PosePrior& prior) const;
  /** A pose that no scan had a say in. @param inlier_share to go on with */
  static Proposal unseen(const mrpt::math::TPose2D& pose, float inlier_share);
  Proposal proposal(const MatchResult& match, const PosePrior& prior, double extra_cost,
                    bool by_odometry) const;
  /** All modes where odometry or the match with it is in doubt. @param search also by correlative search */
  std::vector<Proposal> alternatives(const Particle& particle, const LaserPoints& scan,
                                     const PosePrior& prior, const MatchResult& match, bool search);
  void addSlips(std::vector<Proposal>& modes, const Particle& particle, const LaserPoints& scan,
                const PosePrior& prior, bool search) const;
  /** Odometry's prediction from the last node that agreed with it; empty if that was the last node, or if
   * odometry is missing since. */
  std::optional<PosePrior> priorSinceAgreement(const Particle& particle) const;
  Proposal sampled(const Proposal& around, const PosePrior& prior);
  void extend(Particle& particle, const LaserPoints& scan, const Proposal& proposal);
  void normalise();
  void prune();
  void resample();

  FilterParams params_;
  ScanMatcher matcher_;
  std::mt19937_64 random_;
  std::vector<Particle> particles_;
  std::vector<mrpt::math::TPose2D> odometry_;  ///< T_start_frame by odometry alone, one for each frame so far
  std::size_t odometry_since_ = 0;             ///< first frame after the last one that odometry did not reach
  uint32_t rescues_ = 0, resamplings_ = 0;
};

}  // namespace submap_slam
