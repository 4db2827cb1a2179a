#include "levenberg_marquardt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace submap_slam::grid_joining {
namespace {

constexpr double kDampingUp = 10, kDampingDown = 0.1, kSmallestDamping = 1e-9;

/** Less damping than that hardly changes a step, so it is not tried after a step that was refused. */
constexpr double kEffectiveDamping = 1e-2;

constexpr double kLongestStretch = 5;

/** How much lower the trial is than `now`, as the problem wants it judged; negative if higher. */
double decrease(const LevelProblem& problem, const Evaluation& now, const Evaluation& trial) {
  if (!problem.per_overlap) return now.objective - trial.objective;
  return now.objective - objectiveAtOverlap(trial, problem.evidence_variance, now.overlap);
}

std::optional<Eigen::VectorXd> dampedStep(const LevelProblem& problem,
                                          const LevenbergMarquardtOptions& options, const Frames& frames,
                                          const Evaluation& now, const std::vector<bool>& held,
                                          double damping) {
  const Eigen::VectorXd added = dampingDiagonal(now.total, damping);
  if (!options.step) return solve(now.total, held, added);
  PoseSystem pose_terms(frames.size());
  pose_terms.add(now.prior, problem.evidence_variance);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Eigen::Vector3d diagonal =
        problem.evidence_variance * added.segment<3>(3 * static_cast<Eigen::Index>(i));
    pose_terms.addBlock(i, i, diagonal.asDiagonal());
  }
  return options.step(frames, pose_terms, held);
}

/** How far the next step should go, in Gauss-Newton steps: the ratio of the curvature that the normal
 * equations promised along the last step to the one that its gradients show (Barzilai and Borwein 1988, in
 * the metric of the normal equations). The roughness of the evidence adds to J^T J, but not to the curvature
 * of the cost, so that plain steps are several times too short where there is little structure. */
double secantStretch(const Eigen::VectorXd& step, double stretch, const PoseSystem& before,
                     const PoseSystem& after) {
  const double promised = -stretch * step.dot(before.denseGradient());
  const double seen = step.dot(after.denseGradient() - before.denseGradient());
  return seen * kLongestStretch > promised ? std::max(1.0, promised / seen) : kLongestStretch;
}

JoinIteration describe(const Eigen::VectorXd& step, double objective) {
  JoinIteration iteration;
  iteration.cost = objective;
  for (Eigen::Index k = 0; k < step.size(); k += 3) {
    iteration.max_step_m = std::max(iteration.max_step_m, std::hypot(step[k], step[k + 1]));
    iteration.max_step_rad = std::max(iteration.max_step_rad, std::abs(step[k + 2]));
  }
  return iteration;
}

}  // namespace

Evaluation evaluate(const LevelProblem& problem, const Frames& frames) {
  const PlacedLevels placed(problem.level, frames, problem.lattice_angle);
  Evaluation e{problem.single_precision ? reduce<float>(placed, frames, problem.jacobian)
                                        : reduce<double>(placed, frames, problem.jacobian),
               problem.prior.linearise(frames), PoseSystem(frames.size())};
  if (problem.per_overlap) e.overlap = overlapWeight(placed);
  e.prior_cost = problem.prior.cost(frames);
  weigh(problem, e);
  return e;
}

void weigh(const LevelProblem& problem, Evaluation& e) {
  e.objective = e.evidence.cost / problem.evidence_variance + e.prior_cost;
  e.total = e.prior;
  e.total.add(e.evidence.system, 1 / problem.evidence_variance);
}

double objectiveAtOverlap(const Evaluation& evaluation, double evidence_variance, double overlap) {
  if (evaluation.overlap <= 0) return std::numeric_limits<double>::infinity();
  const double scale = overlap / evaluation.overlap;
  return scale * evaluation.evidence.cost / evidence_variance + evaluation.prior_cost;
}

double estimateEvidenceVariance(const ReducedSystem& evidence, double cell_size_m,
                                double correlation_length_m) {
  if (evidence.observations == 0) return 1;
  const double redundant = static_cast<double>(evidence.observations - evidence.cells);
  const double floor = 1e-4 * evidence.energy / static_cast<double>(evidence.observations);
  const double cells_together = std::max(1.0, std::pow(correlation_length_m / cell_size_m, 2));
  const double variance = cells_together * std::max(evidence.cost / redundant, floor);
  return variance > 0 ? variance : 1;
}

const char* toString(StopReason reason) {
  switch (reason) {
    case StopReason::kSmallStep:
      return "the largest step is below the tolerance";
    case StopReason::kSmallDecrease:
      return "the objective falls by less than the tolerance";
    case StopReason::kNoDescent:
      return "no step lowers the objective any more";
    case StopReason::kIterationLimit:
      return "the limit of iterations is reached";
    case StopReason::kCancelled:
      return "stopped on request";
  }
  return "unknown";
}

LevelResult optimise(const LevelProblem& problem, const Frames& start, const Evaluation& at_start,
                     const LevenbergMarquardtOptions& options, const IterationCallback& callback) {
  LevelResult now{start, at_start, {}, StopReason::kIterationLimit};
  const std::vector<bool> held = anchorsOf(now.evaluation.total);
  double damping = options.first_damping, stretch = 1;
  for (int k = 0; k < options.max_iterations; ++k) {
    const auto step = dampedStep(problem, options, now.frames, now.evaluation, held, damping);
    Frames trial_frames = step ? moved(now.frames, stretch * *step) : now.frames;
    Evaluation trial = step ? evaluate(problem, trial_frames) : now.evaluation;
    const double gain = decrease(problem, now.evaluation, trial);
    JoinIteration iteration = step ? describe(*step, std::min(now.evaluation.objective, trial.objective))
                                   : JoinIteration{0, now.evaluation.objective, 0, 0};
    const bool small_step =
        step && iteration.max_step_m < options.max_step_m && iteration.max_step_rad < options.max_step_rad;
    const bool small_decrease = gain > 0 && gain < options.cost_decrease * now.evaluation.objective;
    if (gain > 0) {
      stretch = secantStretch(*step, stretch, now.evaluation.total, trial.total);
      now.frames = std::move(trial_frames);
      now.evaluation = std::move(trial);
      damping = std::max(kSmallestDamping, damping * kDampingDown);
    } else {
      stretch = 1;
      damping = std::max(kEffectiveDamping, damping * kDampingUp);
    }
    now.iterations.push_back(iteration);
    if (callback && !callback(iteration, now.frames)) return now.stop = StopReason::kCancelled, now;
    if (small_step) return now.stop = StopReason::kSmallStep, now;
    if (small_decrease) return now.stop = StopReason::kSmallDecrease, now;
    if (damping > options.largest_damping) return now.stop = StopReason::kNoDescent, now;
  }
  return now;
}

}  // namespace submap_slam::grid_joining
