#include "odometry_pose_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "frame_covariances.h"

namespace submap_slam {

IMPLEMENTS_MRPT_OBJECT(OdometryPoseGraph, SubmapJoiner, submap_slam)

namespace {

using namespace pose_graph;

OdometryResidual residualOf(const std::string& name) {
  return name == "off"      ? OdometryResidual::kOff
         : name == "submap" ? OdometryResidual::kSubmap
                            : OdometryResidual::kConsecutive;
}

std::string describeOdometry(const FusedGraph& fused) {
  const OdometryModel& odometry = fused.odometry;
  if (!odometry.known()) return "no odometry to fuse";
  return fmt::format("odometry strays {:.0f} mm and {:.2f} deg per root metre, scaled by {:.3f} and {:.3f}{}",
                     1e3 * std::sqrt(odometry.variance_xy), std::sqrt(odometry.variance_phi) * 180 / M_PI,
                     odometry.gain_xy, odometry.gain_phi, fused.bent ? ", and bends submaps" : "");
}

/** The chain as the fusion leaves it, so that a joiner behind does not go back to the end poses; with less
 * weight where these were contradicted. */
std::vector<Constraint> chainConstraints(const FrameGraph& graph, const GridSubmaps& submaps) {
  std::vector<Constraint> constraints;
  for (const auto& link : graph.links) {
    if (link.loop || link.by_hand || !submaps[link.from]->has_successor) continue;
    Constraint constraint;
    constraint.from = submaps[link.from]->id;
    constraint.to = submaps[link.to]->id;
    constraint.T_a_b.mean = mrpt::poses::CPose2D(graph.frames[link.to] - graph.frames[link.from]);
    constraint.T_a_b.cov.asEigen() = link.covariance;
    constraint.reason = "end pose of the submap, fused";
    constraints.push_back(constraint);
  }
  return constraints;
}

/** What is by hand, but rejected pairs that the search has listed with what it found. */
std::vector<Constraint> constraintsByHand(const std::vector<Constraint>& initial,
                                          const std::vector<Constraint>& candidates) {
  const auto listed = [&candidates](const Constraint& edit) {
    return std::any_of(candidates.begin(), candidates.end(), [&edit](const Constraint& candidate) {
      return candidate.by_hand &&
             std::minmax(candidate.from, candidate.to) == std::minmax(edit.from, edit.to);
    });
  };
  std::vector<Constraint> constraints;
  for (const Constraint& constraint : initial) {
    if (!constraint.by_hand || (!constraint.accepted && listed(constraint))) continue;
    constraints.push_back(constraint);
    if (!constraint.accepted) constraints.back().reason = "rejected by hand; the search found no such loop";
  }
  return constraints;
}

void append(std::vector<Constraint>& constraints, const std::vector<Constraint>& others) {
  constraints.insert(constraints.end(), others.begin(), others.end());
}

/** Frames for all submaps: those that are known, and the rest hanging on to them as at first. */
std::vector<mrpt::math::TPose2D> completed(std::vector<mrpt::math::TPose2D> frames,
                                           const JoinedMap& initial) {
  for (std::size_t k = frames.size(); k < initial.frames.size(); ++k) {
    const auto at_first = [&](std::size_t i) { return initial.frames[i].mean.asTPose(); };
    frames.push_back(k == 0 ? at_first(0) : frames[k - 1] + (at_first(k) - at_first(k - 1)));
  }
  return frames;
}

/** Loop search that goes on as submaps come, then the fusion of all. */
class GrowingGraph : public IncrementalJoin {
 public:
  GrowingGraph(const LoopSearchParams& search, const FusionParams& fusion)
      : search_(search), fusion_(fusion) {}

  JoinedMap join(const GridSubmaps& submaps, const JoinedMap& initial,
                 const ProgressCallback& progress) override;

 private:
  LoopSearch search_;
  FusionParams fusion_;
};

JoinedMap GrowingGraph::join(const GridSubmaps& submaps, const JoinedMap& initial,
                             const ProgressCallback& progress) {
  JoinedMap joined;
  joined.frames = initial.frames;
  if (submaps.size() < 2) {
    joined.constraints = initial.constraints;
    joined.nodes = initial.nodes;
    joined.status = JoinStatus::kNothingToJoin;
    joined.reason = "there is only one submap";
    return joined;
  }
  const auto report = [&](double share) {
    if (progress.showsFrames()) progress.showFrames(completed(search_.frames(), initial));
    return !progress || progress(share, "closing loops");
  };
  FramesCallback show;
  if (progress.showsFrames()) show = [&progress](const auto& frames) { progress.showFrames(frames); };
  const HandEdits by_hand = handEditsOf(initial.constraints, submaps);
  const LoopSearchResult found = search_.search(submaps, report, by_hand);
  const FusedGraph fused = fuseOdometry(submaps, found.graph, fusion_, show);
  joined.nodes = fused.nodes.empty() ? initial.nodes : fused.nodes;
  joined.constraints = chainConstraints(fused.frames, submaps);
  append(joined.constraints, found.candidates);
  append(joined.constraints, constraintsByHand(initial.constraints, found.candidates));
  const FrameCovariances covariances(fused.frames);
  for (std::size_t i = 0; i < joined.frames.size(); ++i) {
    joined.frames[i].mean = mrpt::poses::CPose2D(fused.frames.frames[i]);
    joined.frames[i].cov.asEigen() = covariances.block(i, i);
  }
  const auto accepted = std::count_if(found.candidates.begin(), found.candidates.end(),
                                      [](const Constraint& c) { return c.accepted; });
  const bool converged = !found.stopped && fused.solution == Solution::kConverged;
  joined.status = converged ? JoinStatus::kConverged : JoinStatus::kIterationLimit;
  joined.reason = fmt::format("{} of {} loop candidates accepted{}; {}", accepted, found.candidates.size(),
                              found.stopped ? ", stopped before the end" : "", describeOdometry(fused));
  return joined;
}

}  // namespace

void OdometryPoseGraph::describe(ParameterTable& table) {
  table.section(name(), "Loop closure and pose graph with fused odometry (Huang et al. 2024)");
  ChainNoise& chain = search_.chain;
  table.add("chain_sigma_xy", chain.sigma_xy_per_m, "m/√m", {0, 10},
            "How far the chain of submaps may drift beyond what the end poses say.");
  table.add("chain_sigma_phi", chain.sigma_phi_per_m, "rad/√m", {0, 1}, "The same for the heading.");
  table.add("chain_odometry_share", chain.odometry_share, "", {0, 10},
            "Share of the difference between end pose and odometry that counts as uncertainty.");
  table.add("usual_chain_xy", chain.usual_xy_per_m, "m/√m", {0, 10},
            "Usual drift of the chain beyond the covariance of the end poses, for the final estimate.");
  table.add("usual_chain_phi", chain.usual_phi_per_m, "rad/√m", {0, 1}, "The same for the heading.");
  table.add("known", search_.known, "m", {0, 100},
            "Pairs of submaps whose relation is known better than that are not matched.");
  table.add("max_window", search_.max_window, "m", {0, 1000},
            "Largest half width of the window in which a submap is searched.");
  table.add("max_window_phi", search_.max_window_phi, "rad", {0, 3.2}, "The same for the heading.");
  table.add("sight", search_.sight, "m", {0, 1000},
            "Distance beyond their paths at which two submaps may still share something.");
  table.add("search_resolution", search_.matcher.pyramid.resolution, "m", {0.01, 10},
            "Cell size of the search of the window.");
  table.add("min_score", search_.matcher.min_score, "", {0, 1}, "Least score of the search of the window.");
  table.add("min_hit_share", search_.min_hit_share, "", {0, 1},
            "Least share of the surfaces of one submap that fall on surfaces of the other.");
  table.add("min_agreement", search_.min_agreement, "", {0, 1},
            "Least share of the surfaces that fall on surfaces, not into free space, of the other submap.");
  table.add("tolerance", search_.matcher.agreement.tolerance, "m", {0, 1},
            "A surface this near to an occupied cell of the other submap falls on it.");
  table.add("lone_window", search_.lone_window, "m", {0, 1000},
            "In wider windows a match needs another one that agrees with it.");
  table.add("match_sigma_xy", search_.match_sigma_xy, "m", {1e-4, 10},
            "Uncertainty of a match beside what its information says.");
  table.add("match_sigma_phi", search_.match_sigma_phi, "rad", {1e-5, 1}, "The same for the heading.");
  table.add(
      "odometry", odometry_,
      "Odometry residuals: between consecutive nodes, between submap frame and node (the paper's), or none",
      {"consecutive", "submap", "off"});
  table.add("odometry_weight_xy", fusion_.odometry_weight_xy, "", {1e-6, 1e6},
            "Factor on the weight that the log suggests for the translation of odometry.");
  table.add("odometry_weight_phi", fusion_.odometry_weight_phi, "", {1e-6, 1e6}, "The same for the heading.");
  table.add(
      "bend_up_to", fusion_.bend_up_to, "", {0, 1e6},
      "Submaps bend if the variance of consecutive odometry is at most so many times the drift of matches; "
      "0: never.");
  table.add("node_distance", fusion_.node_distance, "m", {0.01, 100},
            "Distance between nodes with a pose of their own in the graph.");
  table.add("node_angle", fusion_.node_angle, "rad", {0.01, 7}, "The same for the heading; either suffices.");
  table.add(
      "intra_sigma_xy", fusion_.intra.sigma_xy, "m", {1e-5, 10},
      "Uncertainty of a node's match, of each by itself; what steps of odometry differ by beyond that is "
      "put down to odometry.");
  table.add("intra_sigma_phi", fusion_.intra.sigma_phi, "rad", {1e-6, 1}, "The same for the heading.");
}

JoinedMap OdometryPoseGraph::join(const GridSubmaps& submaps, const JoinedMap& initial,
                                  const ProgressCallback& progress) const {
  return incremental()->join(submaps, initial, progress);
}

std::unique_ptr<IncrementalJoin> OdometryPoseGraph::incremental() const {
  FusionParams fusion = fusion_;
  fusion.odometry = residualOf(odometry_);
  return std::make_unique<GrowingGraph>(search_, fusion);
}

}  // namespace submap_slam
