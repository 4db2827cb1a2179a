#include <submap_slam/mapping/particle_filter.h>

#include <mrpt/math/wrap2pi.h>
#include <mrpt/poses/CPose2D.h>
#include <submap_slam/core/random_stream.h>
#include <submap_slam/mapping/stray_scans.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Two matches closer than this are the same mode. */
constexpr double kSameModeM = 0.1, kSameModeRad = 0.05;

TPose2D compose(const TPose2D& T_a_b, const TPose2D& T_b_c) { return T_a_b + T_b_c; }

bool sameMode(const TPose2D& a, const TPose2D& b) {
  return std::hypot(a.x - b.x, a.y - b.y) < kSameModeM &&
         std::abs(mrpt::math::wrapToPi(a.phi - b.phi)) < kSameModeRad;
}

/** Distance of a pose from the prior's mean, in sigmas. */
double mahalanobis(const TPose2D& pose, const PosePrior& prior) {
  const Eigen::Vector3d d(pose.x - prior.mean.x, pose.y - prior.mean.y,
                          mrpt::math::wrapToPi(pose.phi - prior.mean.phi));
  return std::sqrt(d.dot(prior.information * d));
}

/** True if a search around `a` has looked at `b` with room to spare. */
bool covers(const CorrelativeSearchParams& search, const TPose2D& a, const TPose2D& b) {
  return std::hypot(a.x - b.x, a.y - b.y) < 0.5 * search.window_xy &&
         std::abs(mrpt::math::wrapToPi(a.phi - b.phi)) < 0.5 * search.window_phi;
}

}  // namespace

ParticleFilter::ParticleFilter(const FilterParams& params, uint64_t seed)
    : params_(params), matcher_(params.matcher, params.map.search_radius), random_(seed) {
  particles_.push_back({SurfelMap(params_.map), {}, 0.0});
}

void ParticleFilter::step(const LaserPoints& scan, const std::optional<TPose2D>& increment) {
  odometry_.push_back(odometry_.empty() ? TPose2D()
                                        : compose(odometry_.back(), increment.value_or(TPose2D())));
  if (!increment) odometry_since_ = odometry_.size() - 1;
  std::vector<Particle> next;
  for (auto& particle : particles_) {
    if (particle.path.empty()) {
      extend(particle, scan, unseen({}, 1));
      next.push_back(std::move(particle));
      continue;
    }
    const TPose2D motion = increment.value_or(lastIncrement(particle.path));
    PosePrior prior{compose(particle.path.back().pose, motion), motionInformation(params_.motion, motion)};
    // The robot need not go on as before: without odometry scans must be free to say that it set off.
    if (!increment) prior.information *= params_.slip_information;
    const auto proposals = propose(particle, scan, prior);
    for (std::size_t k = 1; k < proposals.size(); ++k) {
      next.push_back(particle);
      extend(next.back(), scan, proposals[k]);
    }
    extend(particle, scan, proposals.front());
    next.push_back(std::move(particle));
  }
  particles_ = std::move(next);
  normalise();
  if (params_.fixed_particles > 0)
    resample();
  else
    prune();
}

std::vector<ParticleFilter::Proposal> ParticleFilter::propose(const Particle& particle,
                                                              const LaserPoints& scan,
                                                              const PosePrior& prior) {
  if (particle.map.empty() || scan.points.empty())
    return {unseen(prior.mean, particle.path.back().inlier_share)};
  const MatchResult match = matcher_.match(particle.map, scan, prior);
  const bool fits =
      match.inlier_share >= params_.rescue_below * usualInlierShare(particle.path, particle.path.size()) &&
      mahalanobis(match.pose, prior) <= params_.slip_beyond;
  std::vector<Proposal> out;
  if (fits && !isSurprising(particle, prior))
    out.push_back(proposal(match, prior, 0, true));
  else
    out = alternatives(particle, scan, prior, match, !fits);
  if (params_.fixed_particles > 0) out = {sampled(out.front(), prior)};
  return out;
}

bool ParticleFilter::isSurprising(const Particle& particle, const PosePrior& prior) const {
  const TPose2D motion = lastIncrement(particle.path);
  const PosePrior expected{compose(particle.path.back().pose, motion),
                           motionInformation(params_.motion, motion)};
  return particle.path.size() > 1 && mahalanobis(prior.mean, expected) > params_.slip_beyond;
}

ParticleFilter::Proposal ParticleFilter::unseen(const TPose2D& pose, float inlier_share) {
  Proposal blind;
  blind.match.pose = pose;
  blind.match.inlier_share = static_cast<double>(inlier_share);
  return blind;
}

ParticleFilter::Proposal ParticleFilter::proposal(const MatchResult& match, const PosePrior& prior,
                                                  double extra_cost, bool by_odometry) const {
  // Laplace's approximation of the integral over the pose: a wide prior costs where the scan knows better,
  // and costs nothing along a corridor.
  const double volume =
      0.5 * std::log((match.information + prior.information).determinant() / prior.information.determinant());
  return {match, -params_.likelihood_power * (match.cost + volume) - extra_cost, by_odometry};
}

std::vector<ParticleFilter::Proposal> ParticleFilter::alternatives(const Particle& particle,
                                                                   const LaserPoints& scan,
                                                                   const PosePrior& prior,
                                                                   const MatchResult& match, bool search) {
  std::vector<Proposal> modes;
  // Odometry is believed, over the last step or, where it stalled and caught up, since it was right last. Who
  // has found it wrong pays for believing a leap.
  const bool leap = !particle.path.back().by_odometry && isSurprising(particle, prior);
  modes.push_back(proposal(match, prior, leap ? params_.surprise_cost : 0.0,
                           mahalanobis(match.pose, prior) <= params_.slip_beyond));
  if (const auto since = priorSinceAgreement(particle))
    modes.push_back(proposal(matcher_.match(particle.map, scan, *since), *since, 0, true));
  addSlips(modes, particle, scan, prior, search);
  std::stable_sort(modes.begin(), modes.end(),
                   [](const auto& a, const auto& b) { return a.log_weight > b.log_weight; });
  if (!sameMode(modes.front().match.pose, match.pose)) ++rescues_;
  const double least = modes.front().log_weight + std::log(params_.min_weight);
  std::vector<Proposal> out;
  for (const auto& mode : modes) {
    const bool known = std::any_of(out.begin(), out.end(),
                                   [&](const auto& p) { return sameMode(p.match.pose, mode.match.pose); });
    if (!known && mode.log_weight >= least) out.push_back(mode);
  }
  return out;
}

void ParticleFilter::addSlips(std::vector<Proposal>& modes, const Particle& particle, const LaserPoints& scan,
                              const PosePrior& prior, bool search) const {
  const TPose2D &last = particle.path.back().pose, motion = lastIncrement(particle.path);
  const Eigen::Matrix3d information = motionInformation(params_.motion, motion) * params_.slip_information;
  // Wheels that slip go on slipping at no further cost.
  const bool steady = odometry_since_ + 1 < odometry_.size() && !isSurprising(particle, prior);
  const double first = steady ? params_.slip_cost : params_.surprise_cost;
  const double cost = particle.path.back().by_odometry ? first : 0.0;
  const double fitting = params_.rescue_below * usualInlierShare(particle.path, particle.path.size());
  // Odometry is given up only for a pose that explains the scan, not for one that is merely less bad.
  const auto add = [&](const PosePrior& wide, const TPose2D& start) {
    const MatchResult match = matcher_.match(particle.map, scan, wide, start);
    if (match.inlier_share >= fitting) modes.push_back(proposal(match, wide, cost, false));
  };
  std::vector<TPose2D> searched;
  // The robot is about where odometry says, or went on as before, or stood still.
  for (const auto& centre : {prior.mean, compose(last, motion), last}) {
    const PosePrior wide{centre, information};
    add(wide, centre);
    const bool covered = std::any_of(searched.begin(), searched.end(),
                                     [&](const auto& c) { return covers(params_.search, c, centre); });
    if (!search || covered) continue;
    searched.push_back(centre);
    for (const auto& peak : correlativeSearch(particle.map, scan, centre, params_.search))
      add(wide, peak.pose);
  }
}

std::optional<PosePrior> ParticleFilter::priorSinceAgreement(const Particle& particle) const {
  std::size_t k = particle.path.size() - 1;
  while (k > 0 && !particle.path[k].by_odometry) --k;
  if (k + 1 == particle.path.size()) return std::nullopt;  // the last step's own prior says the same
  if (k < odometry_since_) return std::nullopt;            // a gap lies in between
  const TPose2D motion = odometry_.back() - odometry_[k];
  return PosePrior{compose(particle.path[k].pose, motion), motionInformation(params_.motion, motion)};
}

ParticleFilter::Proposal ParticleFilter::sampled(const Proposal& around, const PosePrior& prior) {
  const Eigen::Matrix3d information = around.match.information + prior.information;
  const Eigen::Vector3d standard(standardNormal(random_), standardNormal(random_), standardNormal(random_));
  // Λ = L Lᵀ: x = L⁻ᵀ z has covariance Λ⁻¹.
  const Eigen::Vector3d offset = information.llt().matrixU().solve(standard);
  Proposal out = around;
  out.match.pose = {around.match.pose.x + offset.x(), around.match.pose.y + offset.y(),
                    mrpt::math::wrapToPi(around.match.pose.phi + offset.z())};
  return out;
}

void ParticleFilter::extend(Particle& particle, const LaserPoints& scan, const Proposal& proposal) {
  PathNode node;
  node.take(proposal.match);
  node.by_odometry = proposal.by_odometry;
  const bool far = !scan.points.empty() && isKeyPose(particle.path, node.pose, params_.keys);
  particle.path.push_back(node);
  const std::size_t strays = scansThatFitNothing(particle.path, particle.path.size() - 1);
  if (far && (strays == 0 || strays > kStrayScans)) {
    particle.path.back().key = true;
    particle.map.insert(scan, node.pose);
  }
  particle.log_weight += proposal.log_weight;
}

void ParticleFilter::normalise() {
  double most = -1e300, sum = 0;
  for (const auto& p : particles_) most = std::max(most, p.log_weight);
  for (const auto& p : particles_) sum += std::exp(p.log_weight - most);
  for (auto& p : particles_) p.log_weight -= most + std::log(sum);
}

double ParticleFilter::effectiveParticles() const {
  double sum = 0;
  for (const auto& p : particles_) sum += std::exp(2 * p.log_weight);
  return 1 / sum;
}

const Particle& ParticleFilter::best() const {
  return *std::max_element(particles_.begin(), particles_.end(),
                           [](const auto& a, const auto& b) { return a.log_weight < b.log_weight; });
}

void ParticleFilter::prune() {
  std::stable_sort(particles_.begin(), particles_.end(),
                   [](const auto& a, const auto& b) { return a.log_weight > b.log_weight; });
  std::vector<Particle> kept;
  for (auto& p : particles_) {
    const bool merged = std::any_of(kept.begin(), kept.end(), [&](const auto& k) {
      return k.path.back().by_odometry == p.path.back().by_odometry &&
             sameMode(k.path.back().pose, p.path.back().pose);
    });
    const bool full = kept.size() >= static_cast<std::size_t>(params_.max_particles);
    if (merged || full || p.log_weight < std::log(params_.min_weight)) continue;
    kept.push_back(std::move(p));
    if (kept.size() == 1 && std::exp(kept.front().log_weight) >= params_.decided_weight) break;
  }
  particles_ = std::move(kept);
  normalise();
}

void ParticleFilter::resample() {
  const auto wanted = static_cast<std::size_t>(params_.fixed_particles);
  if (particles_.size() == wanted &&
      effectiveParticles() >= params_.resample_below * static_cast<double>(wanted))
    return;
  if (particles_.size() == wanted) ++resamplings_;
  // Systematic resampling: one random offset, equally spaced picks.
  const double first = std::generate_canonical<double, 53>(random_) / static_cast<double>(wanted);
  std::vector<Particle> picked;
  double cumulative = std::exp(particles_.front().log_weight);
  std::size_t source = 0;
  for (std::size_t k = 0; k < wanted; ++k) {
    const double at = first + static_cast<double>(k) / static_cast<double>(wanted);
    while (cumulative < at && source + 1 < particles_.size())
      cumulative += std::exp(particles_[++source].log_weight);
    picked.push_back(particles_[source]);
    picked.back().log_weight = -std::log(static_cast<double>(wanted));
  }
  particles_ = std::move(picked);
}

}  // namespace submap_slam
