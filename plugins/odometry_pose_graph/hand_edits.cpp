#include "hand_edits.h"

#include <algorithm>
#include <cstdint>
#include <map>

namespace submap_slam::pose_graph {

HandEdits handEditsOf(const std::vector<Constraint>& constraints, const GridSubmaps& submaps) {
  std::map<uint32_t, std::size_t> frame_of;
  for (std::size_t k = 0; k < submaps.size(); ++k) frame_of.emplace(submaps[k]->id, k);
  HandEdits edits;
  for (const Constraint& constraint : constraints) {
    const auto from = frame_of.find(constraint.from), to = frame_of.find(constraint.to);
    if (!constraint.by_hand || from == frame_of.end() || to == frame_of.end()) continue;
    if (!constraint.accepted) {
      edits.refused.insert({std::max(from->second, to->second), std::min(from->second, to->second)});
      continue;
    }
    Link link;
    link.from = from->second;
    link.to = to->second;
    link.T_a_b = constraint.T_a_b.mean.asTPose();
    link.covariance = link.usual_covariance = constraint.T_a_b.cov.asEigen();
    link.by_hand = true;
    edits.links.push_back(link);
  }
  return edits;
}

}  // namespace submap_slam::pose_graph
