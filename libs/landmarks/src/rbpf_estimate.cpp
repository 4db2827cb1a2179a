/** What the particles of an RbpfFilter say of the submap in the end. */
#include <algorithm>
#include <cmath>
#include <map>

#include <submap_slam/landmarks/path_smoother.h>
#include "rbpf_filter.h"

namespace submap_slam::landmark_mapping {
namespace {

/** Each one takes its time: that of a filter for one path. */
constexpr std::size_t kMostAssociations = 3;

/** Of the components that are kept; headings near to those of the first. */
std::vector<Pose> meanPath(const std::vector<std::vector<Pose>>& paths,
                           const std::vector<MixtureComponent>& components,
                           const std::vector<std::size_t>& kept) {
  const std::vector<Pose>& standard = paths[kept.front()];
  std::vector<Pose> sum(standard.size(), Pose::Zero());
  double weights = 0;
  for (const std::size_t j : kept) {
    const double w = components[j].weight;
    weights += w;
    for (std::size_t k = 0; k < standard.size(); ++k) {
      const Pose& pose = paths[j][k];
      sum[k] += w * Pose(pose[0], pose[1], standard[k][2] + wrapped(pose[2] - standard[k][2]));
    }
  }
  for (Pose& pose : sum) pose /= weights;
  return sum;
}

}  // namespace

std::vector<Pose> RbpfFilter::pathOf(const Particle& particle) const {
  std::vector<Pose> path;
  for (std::size_t node = particle.path; node != 0; node = nodes_[node].before)
    path.push_back(nodes_[node].pose);
  std::reverse(path.begin(), path.end());
  return path;
}

std::vector<RbpfFilter::Seen> RbpfFilter::associationOf(const Particle& particle) const {
  std::vector<Seen> seen;
  for (std::size_t node = particle.path; node != 0; node = nodes_[node].before)
    seen.insert(seen.end(), nodes_[node].seen.rbegin(), nodes_[node].seen.rend());
  std::reverse(seen.begin(), seen.end());
  return seen;
}

std::vector<Feature> RbpfFilter::featuresOf(const Particle& particle) {
  std::vector<Feature> features;
  for (const FeatureMap::Place& place : particle.features.all())
    features.push_back(particle.features.at(place));
  return features;
}

RbpfFilter::Mixture RbpfFilter::mixtureOfParticles() const {
  Mixture mixture;
  for (const Particle& p : particles_) {
    mixture.components.push_back({std::exp(p.log_weight), p.pose, p.covariance, featuresOf(p), {}});
    mixture.paths.push_back(pathOf(p));
  }
  return mixture;
}

/** Of the associations those with the most weight; usually one has nearly all of it. One that cannot be
 * smoothed is left out. @return empty if that is the heaviest: the others do not stand for it */
RbpfFilter::Mixture RbpfFilter::mixtureOfAssociations() const {
  struct Group {
    const Particle* heaviest = nullptr;
    double weight = 0;
  };
  std::map<std::vector<Seen>, Group> by_association;
  for (const Particle& p : particles_) {
    Group& group = by_association[associationOf(p)];
    group.weight += std::exp(p.log_weight);
    if (group.heaviest == nullptr || p.log_weight > group.heaviest->log_weight) group.heaviest = &p;
  }
  std::vector<std::pair<std::vector<Seen>, Group>> groups(by_association.begin(), by_association.end());
  std::stable_sort(groups.begin(), groups.end(),
                   [](const auto& a, const auto& b) { return a.second.weight > b.second.weight; });
  if (groups.size() > kMostAssociations) groups.resize(kMostAssociations);
  Mixture mixture;
  for (const auto& [association, group] : groups) {
    const bool added = addSmoothed(*group.heaviest, association, group.weight, mixture);
    if (!added && mixture.components.empty()) return {};
  }
  double sum = 0;
  for (const auto& component : mixture.components) sum += component.weight;
  for (auto& component : mixture.components) component.weight /= sum;
  return mixture;
}

bool RbpfFilter::addSmoothed(const Particle& particle, const std::vector<Seen>& association, double weight,
                             Mixture& mixture) const {
  std::vector<Sighting> sightings;
  std::map<uint32_t, std::size_t> index;
  for (const Seen& seen : association) {
    const RecordedScan& recorded = scans_[seen.scan];
    sightings.push_back({recorded.step, recorded.scan.T_robot_sensor,
                         recorded.scan.measurements[seen.measurement].value,
                         index.emplace(seen.feature, index.size()).first->second});
  }
  const auto smoothed = smoothSubmap(steps_, sightings, pathOf(particle));
  if (!smoothed) return false;
  MixtureComponent component;
  component.weight = weight;
  component.pose = smoothed->path.back();
  component.features = featuresOf(particle);
  std::vector<std::size_t> order;
  for (Feature& feature : component.features) {
    order.push_back(index.at(feature.id));
    feature.mean = smoothed->features[order.back()];
  }
  const auto rows = rowsOf(order);
  component.covariance = smoothed->covariance(rows, rows);
  mixture.components.push_back(std::move(component));
  mixture.paths.push_back(smoothed->path);
  return true;
}

LandmarkEstimate RbpfFilter::estimate() const {
  MixtureOptions options;
  options.min_hits = association_.min_hits;
  Mixture mixture;
  if (smooths_) mixture = mixtureOfAssociations();
  options.small_sample_correction = mixture.components.empty();
  if (mixture.components.empty()) mixture = mixtureOfParticles();
  std::vector<std::size_t> kept;
  LandmarkEstimate estimate = toGaussian(mixture.components, options, kept);
  estimate.path = meanPath(mixture.paths, mixture.components, kept);
  return estimate;
}

}  // namespace submap_slam::landmark_mapping
