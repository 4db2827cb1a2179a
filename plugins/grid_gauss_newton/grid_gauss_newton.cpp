#include "grid_gauss_newton.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace submap_slam {

IMPLEMENTS_MRPT_OBJECT(GridGaussNewton, SubmapJoiner, submap_slam)

namespace {

using namespace grid_joining;

JacobianKind jacobianNamed(const std::string& name) {
  if (name == "paper") return JacobianKind::kPaper;
  return name == "surface" ? JacobianKind::kSurface : JacobianKind::kVariableProjection;
}

SolverKind solverNamed(const std::string& name) {
  if (name == "full") return SolverKind::kFull;
  return name == "explicit_pose_only" ? SolverKind::kExplicitPoseOnly : SolverKind::kPoseOnly;
}

/** Nothing if all submaps have cells of one size. */
std::string describeResolutions(const GridSubmaps& submaps, const std::vector<int>& halvings) {
  const auto finer = std::count_if(halvings.begin(), halvings.end(), [](int n) { return n > 0; });
  if (finer == 0) return "";
  const auto coarsest = std::find(halvings.begin(), halvings.end(), 0) - halvings.begin();
  return fmt::format("{} submaps with smaller cells were summed up to cells of {:g} m", finer,
                     submaps[static_cast<std::size_t>(coarsest)]->resolution());
}

Frames meansOf(const std::vector<mrpt::poses::CPosePDFGaussian>& frames) {
  Frames means;
  for (const auto& frame : frames) means.push_back(frame.mean.asTPose());
  return means;
}

std::vector<uint32_t> idsOf(const GridSubmaps& submaps) {
  std::vector<uint32_t> ids;
  for (const auto& submap : submaps) ids.push_back(submap->id);
  return ids;
}

/** The constraints as a prior. Frames that a joiner optimised are at the optimum of its own objective, which
 * may hold more than the constraints (odometry) and weigh them otherwise (robust loss). To second order that
 * is: the frames are held where they are, as firmly as the constraints say. */
std::vector<Constraint> priorOf(const GridSubmaps& submaps, const JoinedMap& initial) {
  std::vector<Constraint> constraints = initial.constraints;
  if (initial.status != JoinStatus::kConverged && initial.status != JoinStatus::kIterationLimit)
    return constraints;
  std::map<uint32_t, mrpt::poses::CPose2D> frame_of;
  for (std::size_t k = 0; k < submaps.size(); ++k) frame_of[submaps[k]->id] = initial.frames[k].mean;
  for (Constraint& c : constraints) {
    const auto from = frame_of.find(c.from), to = frame_of.find(c.to);
    if (c.accepted && !c.by_hand && from != frame_of.end() && to != frame_of.end())
      c.T_a_b.mean = to->second - from->second;
  }
  return constraints;
}

/** Share of the work done after an iteration: levels count alike, and so do iterations up to the cap. */
double shareDone(int levels, int level, int iteration_of_level, int max_iterations) {
  const double share = std::min(1.0, static_cast<double>(iteration_of_level) / max_iterations);
  return (levels - 1 - level + share) / levels;
}

}  // namespace

void GridGaussNewton::describe(ParameterTable& table) {
  const std::vector<std::string> jacobians{"paper", "variable_projection", "surface"};
  table.section(name(), "Joint optimisation of submap frames and occupancy map (Wang, Zhao, Huang 2025)");
  table.add("levels", levels_, "", {1, 10},
            "Levels of the pyramid of 2 x 2 sums; 1 works at the finest level only.");
  table.add("finest_level", finest_level_, "", {0, 6},
            "Level that counts as the finest; each halves the resolution and saves three quarters of memory "
            "and time.");
  table.add("max_cells", max_cells_, "", {1e4, 1e12},
            "Submaps with more cells in all start at a coarser finest level, which keeps memory and time in "
            "bounds.");
  table.add("solver", solver_,
            "How a step is found: summed cell by cell, by explicit sparse matrices (eq. 13), or with the map "
            "as unknown "
            "(eq. 6); the step is the same.",
            {"pose_only", "explicit_pose_only", "full"});
  table.add("jacobian", jacobian_,
            "Derivative at the finest level: eq. (13) as published, the exact gradient of the reduced cost, "
            "or surfaces "
            "only.",
            jacobians);
  table.add("coarse_jacobian", coarse_jacobian_,
            "Derivative at all other levels; each is finished with that of the finest level.", jacobians);
  table.add("max_iterations", max_iterations_, "", {1, 10000}, "Limit of iterations at each level.");
  table.add("step_tolerance", step_tolerance_, "m", {0, 1},
            "Converged when no frame moves farther and none turns more than turn_tolerance; doubled at each "
            "coarser "
            "level.");
  table.add("turn_tolerance", turn_tolerance_, "rad", {0, 1}, "See step_tolerance.");
  table.add("cost_tolerance", cost_tolerance_, "", {0, 1},
            "Converged when the objective falls by a smaller share; doubled at each coarser level.");
  table.add(
      "prior_weight", prior_weight_, "", {0, 1e9},
      "Factor on the information of the constraints (end poses of the submaps, loop closures), which hold "
      "what the evidence does not show (the length of corridors); 0 ignores them.");
  table.add(
      "correlation_length", correlation_length_, "m", {0, 100},
      "Distance over which cells err together; the evidence counts as one witness for each such square.");
  table.add("lattice_angle", lattice_angle_, "rad", {-3.2, 3.2},
            "Direction of the lattice on which evidence is compared; should not be parallel to walls.");
}

void GridGaussNewton::validate() const {
  if (levels_ + finest_level_ > 12)
    throw ConfigError("[grid_gauss_newton] levels + finest_level must not exceed 12");
}

CoarseToFineOptions GridGaussNewton::options() const {
  CoarseToFineOptions o;
  o.iteration.max_iterations = max_iterations_;
  o.iteration.max_step_m = step_tolerance_;
  o.iteration.max_step_rad = turn_tolerance_;
  o.iteration.cost_decrease = cost_tolerance_;
  o.solver = solverNamed(solver_);
  o.finest_jacobian = jacobianNamed(jacobian_);
  o.coarse_jacobian = jacobianNamed(coarse_jacobian_);
  o.lattice_angle = lattice_angle_;
  o.correlation_length = correlation_length_;
  return o;
}

int GridGaussNewton::finestLevel(const GridSubmaps& submaps, const std::vector<int>& halvings) const {
  double cells = 0;
  for (std::size_t i = 0; i < submaps.size(); ++i)
    cells += static_cast<double>(submaps[i]->evidenceSummary().stored_cells) / std::pow(4, halvings[i]);
  int level = finest_level_;
  for (cells /= std::pow(4, level); cells > max_cells_; cells /= 4) ++level;
  return level;
}

JoinedMap GridGaussNewton::join(const GridSubmaps& submaps, const JoinedMap& initial,
                                const ProgressCallback& progress) const {
  const std::vector<int> halvings = halvingsToCoarsest(submaps);
  JoinedMap joined;
  joined.frames = initial.frames;
  joined.constraints = initial.constraints;
  joined.nodes = initial.nodes;
  if (submaps.size() < 2) {
    joined.status = JoinStatus::kNothingToJoin;
    joined.reason = "there is only one submap";
    return joined;
  }

  int level = levels_ - 1, in_level = 0;
  const auto report = [&](const JoinIteration& i, const Frames& frames) {
    progress.showFrames(frames);
    in_level = i.level == level ? in_level + 1 : 1;
    level = i.level;
    return !progress || progress(shareDone(levels_, level, in_level, max_iterations_), "joining grids");
  };
  const bool as_published = jacobian_ == "paper" || coarse_jacobian_ == "paper";
  const double background = as_published ? 0 : backgroundOf(submaps);
  const auto pyramid = buildPyramid(submaps, {finestLevel(submaps, halvings), levels_, background});
  const CoarseToFineResult result =
      joinCoarseToFine(pyramid, meansOf(initial.frames),
                       ConstraintPrior(priorOf(submaps, initial), submaps, prior_weight_), options(), report);
  joined.status = result.status;
  joined.reason = result.reason;
  joined.objective = result.objective;
  joined.iterations = result.iterations;
  if (result.status == JoinStatus::kNothingToJoin || result.status == JoinStatus::kFailed) return joined;
  const std::vector<uint32_t> ids = idsOf(submaps);
  for (const std::string& remark :
       {describeResolutions(submaps, halvings), describeGroups(result.groups, ids),
        describeOpen(result.open_directions, ids)})
    if (!remark.empty()) joined.reason += "; " + remark;
  for (std::size_t i = 0; i < joined.frames.size(); ++i) {
    joined.frames[i].mean = mrpt::poses::CPose2D(result.frames[i]);
    if (result.covariances[i]) joined.frames[i].cov = *result.covariances[i];
  }
  return joined;
}

}  // namespace submap_slam
