#include <submap_slam/core/joined_landmarks.h>

#include <mrpt/math/wrap2pi.h>
#include <mrpt/poses/CPose2D.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

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

namespace {

using mrpt::math::TPose2D;

/** Path length from the start of the submap to each of its nodes, and last to its end. */
std::vector<double> lengthsOf(const LandmarkSubmap& submap) {
  std::vector<double> lengths;
  TPose2D before;
  double length = 0;
  const auto go = [&](const TPose2D& to) {
    length += std::hypot(to.x - before.x, to.y - before.y);
    before = to;
    lengths.push_back(length);
  };
  for (const auto& node : submap.nodes) go(node.pose);
  go(submap.end_pose);
  return lengths;
}

void appendNodes(const LandmarkSubmap& submap, const TPose2D& start, const TPose2D& end, Trajectory& path) {
  const TPose2D joined_end = end - start;  // T_s_end
  const TPose2D& own_end = submap.end_pose;
  const auto lengths = lengthsOf(submap);
  for (std::size_t k = 0; k < submap.nodes.size(); ++k) {
    const double share = lengths.back() > 0 ? lengths[k] / lengths.back() : 0;
    TPose2D pose = submap.nodes[k].pose;
    pose.x += share * (joined_end.x - own_end.x);
    pose.y += share * (joined_end.y - own_end.y);
    pose.phi = mrpt::math::wrapToPi(pose.phi + share * mrpt::math::wrapToPi(joined_end.phi - own_end.phi));
    path.push_back({submap.nodes[k].stamp, start + pose});
  }
}

template <class Condition>
bool allOf(const LandmarkSubmaps& submaps, const Condition& condition) {
  return std::all_of(submaps.begin(), submaps.end(), [&](const auto& submap) { return condition(*submap); });
}

}  // namespace

Trajectory trajectoryOf(const LandmarkSubmaps& submaps, const JoinedLandmarks& joined) {
  if (joined.frames.size() != submaps.size() + 1)
    throw std::invalid_argument("trajectoryOf: expected one frame more than submaps");
  const bool nodes = allOf(submaps, [](const LandmarkSubmap& s) { return !s.nodes.empty(); });
  const bool stamps =
      allOf(submaps, [](const LandmarkSubmap& s) { return s.end_stamp != INVALID_TIMESTAMP; });
  Trajectory path;
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    const TPose2D end = joined.frames[k + 1].mean.asTPose();
    if (nodes) {
      appendNodes(*submaps[k], joined.frames[k].mean.asTPose(), end, path);
    } else {
      path.push_back({stamps ? submaps[k]->end_stamp : mrpt::Clock::fromDouble(static_cast<double>(k)), end});
    }
  }
  return path;
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
