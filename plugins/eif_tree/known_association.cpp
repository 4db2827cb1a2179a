#include "known_association.h"

#include <algorithm>

namespace submap_slam::landmark_joining {

AssociatedProblem associateByIds(const LandmarkSubmaps& submaps) {
  AssociatedProblem associated;
  std::vector<uint32_t>& ids = associated.landmark_ids;
  for (const auto& submap : submaps)
    for (const auto& feature : submap->features) ids.push_back(feature.id);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  associated.hits.resize(ids.size());

  JointProblem& problem = associated.problem;
  problem.landmark_count = ids.size();
  for (const auto& submap : submaps) {
    associated.observations.push_back(
        observationOf(*submap, std::vector<bool>(submap->features.size(), true)));
    std::vector<int> landmarks;
    for (const auto& feature : submap->features) {
      const auto landmark = std::lower_bound(ids.begin(), ids.end(), feature.id) - ids.begin();
      landmarks.push_back(static_cast<int>(landmark));
      associated.hits[static_cast<std::size_t>(landmark)] += feature.hits;
      associated.associations.push_back(
          {submap->id, feature.id, FeatureAssociation::Kind::kKnown, feature.id, 0});
    }
    problem.landmarks.push_back(std::move(landmarks));
  }
  for (const auto& observation : associated.observations) problem.observations.push_back(&observation);
  return associated;
}

}  // namespace submap_slam::landmark_joining
