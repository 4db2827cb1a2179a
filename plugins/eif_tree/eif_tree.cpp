#include "eif_tree.h"

#include <mrpt/math/wrap2pi.h>

#include "known_association.h"

namespace submap_slam {

IMPLEMENTS_MRPT_OBJECT(EifTree, LandmarkJoiner, submap_slam)

namespace {

using namespace landmark_joining;

mrpt::poses::CPosePDFGaussian frameOf(const Pose& pose, const Eigen::Matrix3d& covariance) {
  return {mrpt::poses::CPose2D(pose[0], pose[1], mrpt::math::wrapToPi(pose[2])),
          mrpt::math::CMatrixDouble33(covariance)};
}

void fillIn(const AssociatedProblem& associated, const Joining& joining, JoinedLandmarks& joined) {
  const auto& [state, covariances, result] = joining;
  joined.frames = {frameOf(Pose::Zero(), Eigen::Matrix3d::Zero())};
  for (std::size_t k = 0; k < state.ends.size(); ++k)
    joined.frames.push_back(frameOf(state.ends[k], covariances.ends[k]));
  for (std::size_t m = 0; m < state.landmarks.size(); ++m)
    joined.landmarks.push_back({associated.landmark_ids[m], state.landmarks[m].x(), state.landmarks[m].y(),
                                mrpt::math::CMatrixDouble22(covariances.landmarks[m]), associated.hits[m]});
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
  table.add(
      "relinearise_above", options_.relinearise_above, "m or rad", {0, 1e9},
      "sequential_iterated is relinearised over all submaps when a submap changes an estimate by more.");
  table.add("max_iterations", options_.gauss_newton.max_iterations, "", {1, 10000},
            "Limit of Gauss-Newton iterations over all submaps.");
  table.add("step_tolerance", options_.gauss_newton.max_step_m, "m", {0, 1},
            "Converged when no position changes more and no heading more than turn_tolerance.");
  table.add("turn_tolerance", options_.gauss_newton.max_step_rad, "rad", {0, 1}, "See step_tolerance.");
}

JoiningOptions EifTree::joiningOptions() const {
  JoiningOptions options = options_;
  if (method_ == "tree") options.method = Method::kTree;
  if (method_ == "sequential") options.method = Method::kSequential;
  if (method_ == "sequential_iterated") options.method = Method::kSequentialIterated;
  if (method_ == "ekf") options.method = Method::kDenseFilter;
  return options;
}

JoinedLandmarks EifTree::join(const LandmarkSubmaps& submaps, const ProgressCallback& progress) const {
  const auto show = [&](double share) { return !progress || progress(share, "joining landmarks"); };
  const AssociatedProblem associated = associateByIds(submaps);
  const Joining joining = joinBy(joiningOptions(), associated.problem, show);

  JoinedLandmarks joined;
  joined.status = joining.result.status;
  joined.reason = joining.result.reason;
  joined.objective = joining.result.objective;
  joined.iterations = joining.result.iterations;
  joined.associations = associated.associations;
  fillIn(associated, joining, joined);
  return joined;
}

}  // namespace submap_slam
