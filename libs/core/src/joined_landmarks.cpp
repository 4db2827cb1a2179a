#include <submap_slam/core/joined_landmarks.h>

#include <map>
#include <set>

namespace submap_slam {

const char* toString(FeatureAssociation::Kind kind) {
  switch (kind) {
    case FeatureAssociation::Kind::kKnown:
      return "known";
    case FeatureAssociation::Kind::kMatched:
      return "matched";
    case FeatureAssociation::Kind::kNew:
      return "new";
    case FeatureAssociation::Kind::kDropped:
      return "dropped";
  }
  return "unknown";
}

AssociationErrors compareWithIds(const std::vector<FeatureAssociation>& associations) {
  AssociationErrors errors;
  std::map<uint32_t, std::map<uint32_t, std::size_t>> votes;  // for each landmark the ids of its features
  for (const auto& a : associations) {
    if (a.kind == FeatureAssociation::Kind::kDropped) {
      ++errors.dropped;
    } else {
      ++votes[a.landmark][a.feature];
    }
  }
  std::set<uint32_t> stood_for;
  for (const auto& [landmark, ids] : votes) {
    uint32_t id = 0;
    std::size_t most = 0, all = 0;
    for (const auto& [candidate, count] : ids) {
      all += count;
      if (count > most) most = count, id = candidate;
    }
    errors.wrong += all - most;
    if (!stood_for.insert(id).second) ++errors.missed;
  }
  return errors;
}

}  // namespace submap_slam
