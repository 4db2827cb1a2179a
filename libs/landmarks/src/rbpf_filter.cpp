#include "rbpf_filter.h"

#include <submap_slam/core/random_stream.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace submap_slam::landmark_mapping {
namespace {

using Place = FeatureMap::Place;

/** H Σ Hᵀ + R of a feature whose particle has a known pose. */
Eigen::Matrix2d givenPose(const Predicted& predicted, const Feature& feature, const Eigen::Matrix2d& noise) {
  return predicted.by_feature * feature.covariance * predicted.by_feature.transpose() + noise;
}

/** Upper bound of the variance of a located measurement, that of the feature left out (m²). */
double spread2(const RangeBearing& value, const Eigen::Matrix3d& pose) {
  const double r2 = value.z[0] * value.z[0];
  return value.noise(0, 0) + r2 * value.noise(1, 1) + pose(0, 0) + pose(1, 1) + r2 * pose(2, 2);
}

/** Log-likelihood of a measurement that no feature explains: as that of one at the gate. */
double unexplained(const Eigen::Matrix2d& noise, double gate) {
  return -0.5 * (gate + std::log(4 * M_PI * M_PI * noise.determinant()));
}

/** Where a sensor should see a feature, if the scan says how far and how wide it looks. */
class View {
 public:
  View(const MeasuredScan& scan, const Pose& sensor)
      : known_(scan.max_range > 0 && scan.field_of_view > 0),
        range_(kShare * scan.max_range),
        least_cosine_(std::cos(std::min(kShare * scan.field_of_view / 2, M_PI))),
        position_(sensor.head<2>()),
        ahead_(std::cos(sensor[2]), std::sin(sensor[2])) {}

  bool contains(const Point& feature) const {
    const Point d = feature - position_;
    const double distance = d.norm();
    return known_ && distance <= range_ && ahead_.dot(d) >= least_cosine_ * distance;
  }

 private:
  static constexpr double kShare = 0.9;  ///< at the borders of its view a sensor may miss a feature
  bool known_;
  double range_, least_cosine_;
  Point position_, ahead_;
};

}  // namespace

RbpfFilter::RbpfFilter(const LandmarkMapperParams& params, uint64_t seed)
    : association_(params.association),
      params_(params.particles),
      improved_proposal_(params.particles.proposal == "fastslam2"),
      smooths_(params.particles.gaussian == "smoothed" && !params.single_map),
      random_(seed),
      particles_(static_cast<std::size_t>(params.particles.particles)) {
  nodes_.push_back({Pose::Zero(), 0, {}});  // the first node of no particle
  for (auto& particle : particles_) {
    particle.log_weight = -std::log(static_cast<double>(particles_.size()));
    nodes_.push_back({Pose::Zero(), 0, {}});
    particle.path = nodes_.size() - 1;
  }
}

void RbpfFilter::predict(const MotionStep& step) {
  if (smooths_) steps_.push_back(step);
  for (auto& particle : particles_) {
    const Composition moved = compose(particle.pose, step.increment);
    particle.pose = moved.pose;
    particle.covariance = moved.by_a * particle.covariance * moved.by_a.transpose() +
                          moved.by_b * step.covariance * moved.by_b.transpose();
    nodes_.push_back({particle.pose, particle.path, {}});
    particle.path = nodes_.size() - 1;
  }
}

void RbpfFilter::observe(const MeasuredScan& scan) {
  if (smooths_) scans_.push_back({steps_.size(), scan});
  for (auto& particle : particles_) observe(particle, scan);
  normalise();
  depleted_ = effective() < params_.resample_below * static_cast<double>(particles_.size());
  if (depleted_) resample();
}

void RbpfFilter::observe(Particle& particle, const MeasuredScan& scan) {
  if (!scan.measurements.empty() && !improved_proposal_) samplePose(particle);
  const auto places = visible(particle, scan);
  const std::vector<Origin> none(scan.measurements.size());
  const auto certain =
      unrivalled(none.size(), pairingsOf(particle, scan, places, none), association_.match_gate);
  auto matches = matchesAt(places, newMatches(none, certain));
  take(particle, scan, matches);
  const auto origins = assign(certain, pairingsOf(particle, scan, places, certain), association_.match_gate);
  const auto others = matchesAt(places, newMatches(certain, origins));
  take(particle, scan, others);
  matches.insert(matches.end(), others.begin(), others.end());

  noteOrigins(particle, scan, origins, places);
  if (!scan.measurements.empty() && improved_proposal_) samplePose(particle);
  nodes_[particle.path].pose = particle.pose;
  const Composition sensor = compose(particle.pose, scan.T_robot_sensor);
  updateFeatures(particle, scan, sensor, matches, places);
  addNew(particle, scan, sensor, origins);
}

std::vector<RbpfFilter::Match> RbpfFilter::matchesAt(
    const std::vector<Place>& places, const std::vector<std::pair<std::size_t, std::size_t>>& found) {
  std::vector<Match> matches;
  matches.reserve(found.size());
  for (const auto& [measurement, feature] : found) matches.push_back({measurement, places[feature]});
  return matches;
}

/** Matches tell the pose, or the weight of the one that is drawn already. */
void RbpfFilter::take(Particle& particle, const MeasuredScan& scan, const std::vector<Match>& matches) const {
  if (improved_proposal_)
    improveProposal(particle, scan, matches);
  else
    weigh(particle, scan, matches);
}

void RbpfFilter::noteOrigins(Particle& particle, const MeasuredScan& scan, const std::vector<Origin>& origins,
                             const std::vector<Place>& places) {
  for (std::size_t m = 0; m < origins.size(); ++m) {
    if (origins[m].kind == Origin::Kind::kFeature)
      note(particle, m, particle.features.at(places[origins[m].feature]).id);
    else if (!scan.measurements[m].known_id)
      particle.log_weight += unexplained(scan.measurements[m].value.noise, association_.new_gate);
  }
}

void RbpfFilter::note(const Particle& particle, std::size_t measurement, uint32_t feature) {
  if (smooths_) nodes_[particle.path].seen.push_back({scans_.size() - 1, measurement, feature});
}

/** Features that the scan may see, and those that it names. */
std::vector<Place> RbpfFilter::visible(const Particle& particle, const MeasuredScan& scan) const {
  const Pose sensor = compose(particle.pose, scan.T_robot_sensor).pose;
  double range = scan.max_range;
  for (const auto& m : scan.measurements) range = std::max(range, m.value.z[0]);
  constexpr double kMargin = 10;  // m
  auto places = particle.features.around(sensor.head<2>(), range + kMargin);
  const auto named = [&](const Measurement& m) {
    return !m.known_id || std::any_of(places.begin(), places.end(), [&](const Place& place) {
      return particle.features.at(place).id == *m.known_id;
    });
  };
  if (!std::all_of(scan.measurements.begin(), scan.measurements.end(), named))
    places = particle.features.all();
  return places;
}

/** Of the measurements that have no feature yet. */
std::vector<Pairing> RbpfFilter::pairingsOf(const Particle& particle, const MeasuredScan& scan,
                                            const std::vector<Place>& places,
                                            const std::vector<Origin>& origins) const {
  const Composition sensor = compose(particle.pose, scan.T_robot_sensor);
  std::vector<Pairing> pairings;
  for (std::size_t m = 0; m < origins.size(); ++m) {
    if (origins[m].kind == Origin::Kind::kFeature) continue;
    const Measurement& measurement = scan.measurements[m];
    const RangeBearing& value = measurement.value;
    const Point located = locate(sensor, value.z).feature;
    const double spread = spread2(value, particle.covariance);
    for (std::size_t f = 0; f < places.size(); ++f) {
      const Feature& feature = particle.features.at(places[f]);
      if (measurement.known_id) {
        if (feature.known && feature.id == *measurement.known_id) pairings.push_back({m, f, 0});
        continue;
      }
      const double reach2 = association_.new_gate * 1.5 * (spread + feature.covariance.trace());
      if ((feature.mean - located).squaredNorm() > reach2) continue;
      const Predicted p = predictMeasurement(sensor, feature.mean);
      const Eigen::Matrix2d s =
          p.by_pose * particle.covariance * p.by_pose.transpose() + givenPose(p, feature, value.noise);
      const double distance2 = squaredDistance(innovationOf(value.z, p.z), s);
      if (distance2 <= association_.new_gate) pairings.push_back({m, f, distance2});
    }
  }
  return pairings;
}

/** FastSLAM 2: the pose Gaussian takes one measurement after the other; the likelihoods of these innovations
 * multiply to the particle's weight. */
void RbpfFilter::improveProposal(Particle& particle, const MeasuredScan& scan,
                                 const std::vector<Match>& matches) const {
  Eigen::Matrix3d& covariance = particle.covariance;
  for (const Match& match : matches) {
    const Feature& feature = particle.features.at(match.place);
    const RangeBearing& value = scan.measurements[match.measurement].value;
    const Predicted p = predictMeasurement(particle.pose, scan.T_robot_sensor, feature.mean);
    const Eigen::Matrix<double, 3, 2> p_ht = covariance * p.by_pose.transpose();
    const Eigen::Matrix2d s = p.by_pose * p_ht + givenPose(p, feature, value.noise);
    const Eigen::Vector2d v = innovationOf(value.z, p.z);
    particle.log_weight += measure(v, s).logLikelihood();
    const Eigen::Matrix<double, 3, 2> gain = p_ht * s.inverse();
    particle.pose += gain * v;
    covariance -= gain * p_ht.transpose();
    covariance = (covariance + covariance.transpose()).eval() / 2;
  }
}

void RbpfFilter::samplePose(Particle& particle) {
  Eigen::Vector3d standard;
  for (double& x : standard) x = standardNormal(random_);
  const Eigen::LDLT<Eigen::Matrix3d> ldlt(particle.covariance);
  const Eigen::Vector3d root = ldlt.vectorD().cwiseMax(0).cwiseSqrt();
  const Eigen::Vector3d correlated = ldlt.matrixL() * root.cwiseProduct(standard);
  const Eigen::Vector3d offset = ldlt.transpositionsP().transpose() * correlated;
  particle.pose += offset;
  particle.covariance.setZero();
}

/** FastSLAM 1: likelihood of the measurements at the sampled pose. */
void RbpfFilter::weigh(Particle& particle, const MeasuredScan& scan,
                       const std::vector<Match>& matches) const {
  for (const Match& match : matches) {
    const Feature& feature = particle.features.at(match.place);
    const RangeBearing& value = scan.measurements[match.measurement].value;
    const Predicted p = predictMeasurement(particle.pose, scan.T_robot_sensor, feature.mean);
    particle.log_weight +=
        measure(innovationOf(value.z, p.z), givenPose(p, feature, value.noise)).logLikelihood();
  }
}

/** Kalman update of each matched feature; evidence for these, and against those that should have been seen.
 */
void RbpfFilter::updateFeatures(Particle& particle, const MeasuredScan& scan, const Composition& sensor,
                                const std::vector<Match>& matches, const std::vector<Place>& places) const {
  std::vector<std::pair<Place, Feature>> changes;
  changes.reserve(matches.size());
  for (const Match& match : matches) {
    Feature feature = particle.features.at(match.place);
    const RangeBearing& value = scan.measurements[match.measurement].value;
    const Predicted p = predictMeasurement(sensor, feature.mean);
    const Eigen::Matrix2d p_ht = feature.covariance * p.by_feature.transpose();
    const Eigen::Matrix2d gain = p_ht * givenPose(p, feature, value.noise).inverse();
    feature.mean += gain * innovationOf(value.z, p.z);
    feature.covariance -= gain * p_ht.transpose();
    feature.covariance = (feature.covariance + feature.covariance.transpose()).eval() / 2;
    feature.evidence += params_.seen;
    ++feature.hits;
    changes.emplace_back(match.place, feature);
  }
  particle.features.update(changes, missed(particle, scan, sensor, matches, places), params_.missed);
}

/** Features that the sensor should have seen and did not. */
std::vector<Place> RbpfFilter::missed(const Particle& particle, const MeasuredScan& scan,
                                      const Composition& sensor, const std::vector<Match>& matches,
                                      const std::vector<Place>& places) const {
  std::vector<Place> missed;
  if (params_.missed == 0) return missed;
  const View view(scan, sensor.pose);
  for (const Place& place : places) {
    const Feature& feature = particle.features.at(place);
    if (feature.known || !view.contains(feature.mean)) continue;
    const auto is_here = [&place](const Match& match) { return match.place == place; };
    if (std::none_of(matches.begin(), matches.end(), is_here)) missed.push_back(place);
  }
  return missed;
}

void RbpfFilter::addNew(Particle& particle, const MeasuredScan& scan, const Composition& sensor,
                        const std::vector<Origin>& origins) {
  for (std::size_t m = 0; m < origins.size(); ++m) {
    if (origins[m].kind != Origin::Kind::kNew) continue;
    const Measurement& measurement = scan.measurements[m];
    const Located located = locate(sensor, measurement.value.z);
    Feature feature;
    feature.id = measurement.known_id.value_or(measurement.index);
    feature.known = measurement.known_id.has_value();
    feature.mean = located.feature;
    feature.covariance =
        located.by_pose * particle.covariance * located.by_pose.transpose() +
        located.by_measurement * measurement.value.noise * located.by_measurement.transpose();
    feature.evidence = params_.seen;
    particle.features.insert(feature);
    note(particle, m, feature.id);
  }
}

void RbpfFilter::normalise() {
  const double most = best().log_weight;
  double sum = 0;
  for (const auto& p : particles_) sum += std::exp(p.log_weight - most);
  for (auto& p : particles_) p.log_weight -= most + std::log(sum);
}

/** N_eff = 1 / Σ w² */
double RbpfFilter::effective() const {
  double squares = 0;
  for (const auto& p : particles_) squares += std::exp(2 * p.log_weight);
  return 1 / squares;
}

/** Systematic: one random offset, equally spaced picks. */
void RbpfFilter::resample() {
  const auto count = static_cast<double>(particles_.size());
  const double first = std::generate_canonical<double, 53>(random_) / count;
  std::vector<Particle> picked;
  picked.reserve(particles_.size());
  double cumulative = std::exp(particles_.front().log_weight);
  std::size_t source = 0;
  for (std::size_t k = 0; k < particles_.size(); ++k) {
    const double at = first + static_cast<double>(k) / count;
    while (cumulative < at && source + 1 < particles_.size())
      cumulative += std::exp(particles_[++source].log_weight);
    picked.push_back(particles_[source]);
    nodes_.push_back(nodes_[picked.back().path]);  // one that its twins do not write to
    picked.back().path = nodes_.size() - 1;
    picked.back().log_weight = -std::log(count);
  }
  particles_ = std::move(picked);
}

const RbpfFilter::Particle& RbpfFilter::best() const {
  return *std::max_element(particles_.begin(), particles_.end(),
                           [](const Particle& a, const Particle& b) { return a.log_weight < b.log_weight; });
}

Eigen::Matrix3d RbpfFilter::poseCovariance() const {
  const double heading = best().pose[2];
  Pose mean = Pose::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero(), squares = Eigen::Matrix3d::Zero();
  for (const auto& p : particles_) {
    const double w = std::exp(p.log_weight);
    const Pose pose(p.pose[0], p.pose[1], wrapped(p.pose[2] - heading));
    mean += w * pose;
    squares += w * pose * pose.transpose();
    covariance += w * p.covariance;
  }
  return covariance + squares - mean * mean.transpose();
}

std::size_t RbpfFilter::features() const { return best().features.size(); }

}  // namespace submap_slam::landmark_mapping
