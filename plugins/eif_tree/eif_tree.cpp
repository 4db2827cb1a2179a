#include "eif_tree.h"

#include <fmt/format.h>
#include <mrpt/math/wrap2pi.h>
#include <submap_slam/core/errors.h>

#include <algorithm>

#include "chaining.h"

namespace submap_slam {

IMPLEMENTS_MRPT_OBJECT(EifTree, LandmarkJoiner, submap_slam)

namespace {

using namespace landmark_joining;

mrpt::poses::CPosePDFGaussian frameOf(const Pose& pose, const Eigen::Matrix3d& covariance) {
  return {mrpt::poses::CPose2D(pose[0], pose[1], mrpt::math::wrapToPi(pose[2])),
          mrpt::math::CMatrixDouble33(covariance)};
}

JoinedLandmarks resultOf(const AssociatedProblem& associated, const Joining& joining) {
  JoinedLandmarks joined;
  joined.status = joining.result.status;
  joined.reason = joining.result.reason;
  joined.objective = joining.result.objective;
  joined.iterations = joining.result.iterations;
  joined.associations = associated.associations;
  const auto& [state, covariances, result] = joining;
  joined.frames = {frameOf(Pose::Zero(), Eigen::Matrix3d::Zero())};
  for (std::size_t k = 0; k < state.ends.size(); ++k)
    joined.frames.push_back(frameOf(state.ends[k], covariances.ends[k]));
  for (std::size_t m = 0; m < state.landmarks.size(); ++m)
    joined.landmarks.push_back({associated.landmark_ids[m], state.landmarks[m].x(), state.landmarks[m].y(),
                                mrpt::math::CMatrixDouble22(covariances.landmarks[m]), associated.hits[m]});
  return joined;
}

/** What is left where the association failed: end poses one after the other, and no landmarks. */
JoinedLandmarks withoutLandmarks(const LandmarkSubmaps& submaps, const std::string& reason) {
  AssociatedProblem associated;
  for (const auto& submap : submaps)
    associated.observations.push_back(observationOf(*submap, std::vector<bool>(submap->features.size())));
  for (const auto& observation : associated.observations)
    associated.problem.observations.push_back(&observation);
  associated.problem.landmarks.resize(submaps.size());
  Estimate estimate = chained(associated.problem);
  Joining joining{std::move(estimate.state), std::move(estimate.covariances), {}};
  joining.result.status = JoinStatus::kFailed;
  joining.result.reason = reason;
  return resultOf(associated, joining);
}

}  // namespace

void EifTree::describe(ParameterTable& table) {
  table.section(name(), "Joining of landmark submaps in sparse information form");
  table.add("method", method_,
            "Binary tree with a final Gauss-Newton over all submaps, tree alone, one after the other "
            "(SLSJF), the same "
            "relinearised (I-SLSJF), or dense extended Kalman filter.",
            {"tree_gn", "tree", "sequential", "sequential_iterated", "ekf"});
  table.add("steps_per_join", options_.steps_per_join, "", {1, 100},
            "Gauss-Newton steps after each join of the tree.");
  table.add("relinearise_above", options_.relinearise_above, "m or rad", {0, 1e9},
            "sequential_iterated is relinearised over all submaps when one changes an estimate by more.");
  table.add("max_iterations", options_.gauss_newton.max_iterations, "", {1, 10000},
            "Limit of Gauss-Newton iterations over all submaps.");
  table.add("step_tolerance", options_.gauss_newton.max_step_m, "m", {0, 1},
            "Converged when no position changes more and no heading more than turn_tolerance.");
  table.add("turn_tolerance", options_.gauss_newton.max_step_rad, "rad", {0, 1}, "See step_tolerance.");
  table.add("association", association_,
            "How features of different submaps are matched: by the ids that they have, or without looking at "
            "these by position: nearest neighbours, or the set of joint compatibility branch and bound where "
            "that is half as large again. Pairings that are less likely than a new landmark are left away. "
            "Submaps without ids are matched by the latter.",
            {"known", "nearest_neighbour", "jcbb"});
  table.add("match_gate", association_options_.match_gate, "", {0, 1e9},
            "Largest squared Mahalanobis distance of a match by position.");
  table.add("new_gate", association_options_.new_gate, "", {0, 1e9},
            "A feature is a new landmark beyond this squared distance from all others, and where its pairing "
            "was left away; between the gates it is left out.");
  table.add(
      "search_margin", association_options_.search_margin_m, "m", {0, 1e6},
      "Landmarks so far from a feature are looked at, besides the uncertainty of where its submap starts.");
  table.add("merge", association_options_.merge, "Merge landmarks that turn out to be one in the end.");
}

void EifTree::validate() const {
  if (association_options_.new_gate < association_options_.match_gate)
    throw ConfigError("[eif_tree] new_gate must not be less than match_gate");
}

JoiningOptions EifTree::joiningOptions() const {
  JoiningOptions options = options_;
  if (method_ == "tree") options.method = Method::kTree;
  if (method_ == "sequential") options.method = Method::kSequential;
  if (method_ == "sequential_iterated") options.method = Method::kSequentialIterated;
  if (method_ == "ekf") options.method = Method::kDenseFilter;
  return options;
}

bool EifTree::goesByIds(const LandmarkSubmaps& submaps) const {
  return association_ == "known" &&
         std::all_of(submaps.begin(), submaps.end(), [](const auto& submap) { return submap->ids_known; });
}

namespace {

/** Share of the work as joiners tell it to the program. */
std::function<bool(double)> shown(const ProgressCallback& progress) {
  return [&progress](double share) { return !progress || progress(share, "joining landmarks"); };
}

}  // namespace

JoinedLandmarks EifTree::join(const LandmarkSubmaps& submaps, const ProgressCallback& progress) const {
  return goesByIds(submaps) ? joinKnown(submaps, shown(progress)) : joinUnknown(submaps, shown(progress));
}

class EifTree::Incremental : public IncrementalLandmarkJoin {
 public:
  explicit Incremental(const EifTree& joiner) : joiner_(joiner), tree_(treeFor(joiner.joiningOptions())) {}

  JoinedLandmarks join(const LandmarkSubmaps& submaps, const ProgressCallback& progress) override {
    if (!joiner_.hasTree() || !joiner_.goesByIds(submaps)) return joiner_.join(submaps, progress);
    const AssociatedProblem associated = associateByIds(submaps);
    return resultOf(associated, joinByTree(tree_, associated.landmark_ids, joiner_.joiningOptions(),
                                           associated.problem, shown(progress)));
  }

 private:
  const EifTree& joiner_;
  JoiningTree tree_;
};

std::unique_ptr<IncrementalLandmarkJoin> EifTree::incremental() const {
  return std::make_unique<Incremental>(*this);
}

JoinedLandmarks EifTree::joinKnown(const LandmarkSubmaps& submaps,
                                   const std::function<bool(double)>& progress) const {
  const AssociatedProblem associated = associateByIds(submaps);
  return resultOf(associated, joinBy(joiningOptions(), associated.problem, progress));
}

JoinedLandmarks EifTree::joinUnknown(const LandmarkSubmaps& submaps,
                                     const std::function<bool(double)>& progress) const {
  AssociationOptions options = association_options_;
  options.joint_search = association_ != "nearest_neighbour";
  constexpr double kAssociationShare = 0.95;  // of the time
  auto found = associateByPosition(submaps, options, options_.gauss_newton,
                                   [&](double share) { return progress(kAssociationShare * share); });
  JoinedLandmarks joined;
  if (found) {
    const auto rest = [&](double share) {
      return progress(kAssociationShare + (1 - kAssociationShare) * share);
    };
    // Associating leaves an estimate that needs but a few steps more; the other methods join the pairs anew.
    joined = resultOf(found->associated,
                      method_ == "tree_gn"
                          ? joinFrom(found->state, found->associated.problem, options_.gauss_newton, rest)
                          : joinBy(joiningOptions(), found->associated.problem, rest));
    if (found->associated_submaps < submaps.size() && joined.status != JoinStatus::kFailed) {
      joined.status = JoinStatus::kIterationLimit;
      joined.reason = fmt::format("stopped after {} of {} submaps were associated; the others are chained",
                                  found->associated_submaps, submaps.size());
    }
  } else {
    joined = withoutLandmarks(submaps, "the information matrix is not positive definite");
  }
  joined.association_known = false;
  return joined;
}

}  // namespace submap_slam
