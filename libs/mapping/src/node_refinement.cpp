#include <submap_slam/mapping/node_refinement.h>

#include <mrpt/poses/CPose2D.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "kept_scans.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::poses::CPose2D;

/** A scan and where it is in the global map frame. */
struct KeyScan {
  std::size_t submap = 0, node = 0;
  LaserPoints points;
  TPose2D before, pose;  ///< T_w_n as joined, and refined so far
};

std::vector<KeyScan> keyScansOf(const GridSubmaps& submaps, const JoinedMap& joined,
                                const GridMapperParams& mapper) {
  std::vector<KeyScan> keys;
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    const auto scans = submaps[k]->scans();
    const auto poses = nodePosesOf(submaps, joined, k);
    const TPose2D T_w_s = joined.frames[k].mean.asTPose();
    for (std::size_t i = 0; i < scans.size(); ++i) {
      if (scans[i].empty()) continue;
      const TPose2D T_w_n = T_w_s + poses[i];
      keys.push_back({k, i, pointsOf(scans[i], mapper), T_w_n, T_w_n});
    }
  }
  return keys;
}

/** Matches every scan to the map of all scans where they are now. */
void sweep(std::vector<KeyScan>& keys, const GridMapperParams& mapper, const NodeRefinementParams& params) {
  SurfelMap map(mapper.filter.map);
  for (const auto& key : keys) map.insert(key.points, key.pose);
  const ScanMatcher matcher(mapper.filter.matcher, mapper.filter.map.search_radius);
  const Eigen::Vector3d sigma(params.sigma_xy, params.sigma_xy, params.sigma_phi);
  const Eigen::Matrix3d information = sigma.array().square().inverse().matrix().asDiagonal();
  tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t i) {
    KeyScan& key = keys[i];
    if (!key.points.points.empty()) key.pose = matcher.match(map, key.points, {key.pose, information}).pose;
  });
}

/** How far a key node moved, in its own axes before. */
TPose2D motionOf(const KeyScan& key) { return key.pose - key.before; }

/** (1 − share) · a + share · b, of small motions. */
TPose2D between(const TPose2D& a, const TPose2D& b, double share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.phi + share * (b.phi - a.phi)};
}

/** T_w_n of all nodes of a submap after its key nodes [begin, end) have moved; the others take the motion of
 * the key nodes before and after them, in proportion. */
std::vector<TPose2D> carriedAlong(std::vector<TPose2D> poses, const KeyScan* begin, const KeyScan* end) {
  if (begin == end) return poses;
  const KeyScan* next = begin;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    while (next != end && next->node < i) ++next;
    const KeyScan& after = next != end ? *next : *(end - 1);
    const KeyScan& before = next != begin ? *(next - 1) : *begin;
    const double gap = static_cast<double>(after.node) - static_cast<double>(before.node);
    const double share = gap > 0 ? static_cast<double>(i - before.node) / gap : 0;
    poses[i] = poses[i] + between(motionOf(before), motionOf(after), share);
  }
  return poses;
}

void addMoves(RefinedSubmaps& out, const std::vector<KeyScan>& keys) {
  for (const auto& key : keys) {
    const double move = std::hypot(key.pose.x - key.before.x, key.pose.y - key.before.y);
    out.mean_move += move / static_cast<double>(keys.size());
    out.max_move = std::max(out.max_move, move);
  }
}

/** T_w_n of every node of every submap, from those of the key nodes. */
std::vector<std::vector<TPose2D>> allNodes(const GridSubmaps& submaps, const JoinedMap& joined,
                                           const std::vector<KeyScan>& keys) {
  std::vector<std::vector<TPose2D>> nodes;
  const KeyScan* begin = keys.data();
  const KeyScan* const last = keys.data() + keys.size();
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    const KeyScan* end = std::find_if(begin, last, [&](const KeyScan& key) { return key.submap > k; });
    auto before = nodePosesOf(submaps, joined, k);
    for (auto& pose : before) pose = joined.frames[k].mean.asTPose() + pose;
    nodes.push_back(carriedAlong(std::move(before), begin, end));
    begin = end;
  }
  return nodes;
}

/** The submap again, with its nodes at new poses in the global map frame. */
GridSubmap::Ptr rebuilt(const GridSubmap& submap, const TPose2D& T_w_s, const std::vector<TPose2D>& T_w_nodes,
                        const GridMapperParams& mapper) {
  auto out = GridSubmap::Create();
  out->sensorLabel = submap.sensorLabel;
  out->timestamp = submap.timestamp;
  out->id = submap.id;
  out->first_frame = submap.first_frame;
  out->end_frame = submap.end_frame;
  out->end_pose = submap.end_pose;
  out->has_successor = submap.has_successor;
  out->statistics = submap.statistics;
  const auto scans = submap.scans();
  std::vector<LaserPoints> points;
  points.reserve(scans.size());
  std::vector<PlacedScan> placed;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const SubmapNode& node = submap.nodes[i];
    const TPose2D pose = T_w_nodes[i] - T_w_s;
    out->nodes.push_back({node.stamp, pose, node.odometry, scans[i]});
    if (scans[i].empty()) continue;
    placed.push_back({&points.emplace_back(pointsOf(scans[i], mapper)), pose});
  }
  EvidenceParams evidence = mapper.evidence;
  evidence.resolution = submap.resolution();
  out->evidence = renderEvidence(placed, evidence);
  return out;
}

/** The end pose is where the next submap starts, or the last node where none follows. Submaps without nodes
 * keep theirs. */
void followEndPoses(GridSubmaps& submaps, const std::vector<TPose2D>& T_w_s) {
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    GridSubmap& submap = *submaps[k];
    if (submap.has_successor && k + 1 < submaps.size()) {
      submap.end_pose.mean = CPose2D(T_w_s[k + 1] - T_w_s[k]);
    } else if (!submap.has_successor && !submap.nodes.empty()) {
      submap.end_pose.mean = CPose2D(submap.nodes.back().pose);
    }
  }
}

/** Constraints between frames that moved within their submaps: T_a'_b' = T_a_a'⁻¹ T_a_b T_b_b'. */
void followFrames(std::vector<Constraint>& constraints, const GridSubmaps& submaps,
                  const std::vector<TPose2D>& T_s_moved) {
  const auto movedOf = [&](uint32_t id) {
    const auto at = std::find_if(submaps.begin(), submaps.end(), [&](const auto& s) { return s->id == id; });
    return at == submaps.end() ? TPose2D() : T_s_moved[static_cast<std::size_t>(at - submaps.begin())];
  };
  for (auto& c : constraints)
    c.T_a_b.mean = CPose2D(TPose2D() - movedOf(c.from)) + (c.T_a_b.mean + CPose2D(movedOf(c.to)));
}

}  // namespace

void describe(ParameterTable& table, NodeRefinementParams& p) {
  table.section("node_refinement",
                "Refinement of the scan poses inside submaps, after joining, by all submaps around");
  table.add("rounds", p.rounds, "", {0, 100},
            "Times that the scans are matched to the joined map, the submaps made again and joined again by "
            "the last joiner; 0: never");
  table.add("sweeps", p.sweeps, "", {1, 1000},
            "Times in a round that every scan is matched and the map of all scans made anew");
  table.add("sigma_xy", p.sigma_xy, "m", {1e-6, 10}, "How far a sweep may move a pose");
  table.add("sigma_phi", p.sigma_phi, "rad", {1e-6, 3}, "How far a sweep may turn a pose");
}

RefinedSubmaps refineNodes(const GridSubmaps& submaps, const JoinedMap& joined,
                           const GridMapperParams& mapper, const NodeRefinementParams& params,
                           const std::function<void(GridSubmap&)>& store) {
  if (joined.frames.size() != submaps.size())
    throw std::invalid_argument("one frame is needed for each submap");
  std::vector<KeyScan> keys = keyScansOf(submaps, joined, mapper);
  for (int i = 0; i < params.sweeps; ++i) sweep(keys, mapper, params);
  const auto nodes = allNodes(submaps, joined, keys);
  const auto firstOf = [&](std::size_t k) {
    return nodes[k].empty() ? joined.frames[k].mean.asTPose() : nodes[k].front();
  };

  RefinedSubmaps out;
  addMoves(out, keys);
  out.joined = joined;
  out.joined.status = JoinStatus::kChained;  // the frames are no optimum of anything any more
  out.joined.map = PackedEvidence();
  out.joined.nodes.clear();
  std::vector<TPose2D> T_w_s, T_s_moved;
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    const TPose2D first = firstOf(k);
    T_w_s.push_back(first - firstOf(0));
    T_s_moved.push_back(first - joined.frames[k].mean.asTPose());
    out.joined.frames[k].mean = CPose2D(T_w_s[k]);
    out.submaps.push_back(rebuilt(*submaps[k], first, nodes[k], mapper));
    out.submaps.back()->unload();
    if (store) store(*out.submaps.back());
  }
  followEndPoses(out.submaps, T_w_s);
  followFrames(out.joined.constraints, submaps, T_s_moved);
  return out;
}

}  // namespace submap_slam
