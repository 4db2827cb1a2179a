#include "eif_tree.h"

#include <mrpt/math/wrap2pi.h>

#include "covariances.h"
#include "tree.h"

namespace submap_slam {

IMPLEMENTS_MRPT_OBJECT(EifTree, LandmarkJoiner, submap_slam)

namespace {

using namespace landmark_joining;

mrpt::poses::CPosePDFGaussian frameOf(const Pose& pose, const Eigen::Matrix3d& covariance) {
  return {mrpt::poses::CPose2D(pose[0], pose[1], mrpt::math::wrapToPi(pose[2])),
          mrpt::math::CMatrixDouble33(covariance)};
}

void fillIn(const AssociatedProblem& associated, const JointState& state, const Covariances& covariances,
            JoinedLandmarks& joined) {
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
  table.add("method", method_, "Method", {"tree_gn"});
  table.add("steps_per_join", steps_per_join_, "", {1, 100},
            "Gauss-Newton steps after each join of the tree.");
  table.add("max_iterations", gauss_newton_.max_iterations, "", {1, 10000},
            "Limit of Gauss-Newton iterations over all submaps.");
  table.add("step_tolerance", gauss_newton_.max_step_m, "m", {0, 1},
            "Converged when no position changes more and no heading more than turn_tolerance.");
  table.add("turn_tolerance", gauss_newton_.max_step_rad, "rad", {0, 1}, "See step_tolerance.");
}

JoinedLandmarks EifTree::join(const LandmarkSubmaps& submaps, const ProgressCallback& progress) const {
  JoinedLandmarks joined;
  const AssociatedProblem associated = associateByIds(submaps);
  const auto state = joinTree(associated.problem, {steps_per_join_, false},
                              [&](double share) { return !progress || progress(0.7 * share, "joining"); });
  JointState s = *state;
  InformationForm form(associated.problem);
  const auto result = minimise(associated.problem, form, s, gauss_newton_, {});
  joined.status = result.status;
  joined.reason = result.reason;
  joined.objective = result.objective;
  joined.iterations = result.iterations;
  fillIn(associated, s, marginalCovariances(associated.problem, form), joined);
  joined.associations = associated.associations;
  return joined;
}

}  // namespace submap_slam
