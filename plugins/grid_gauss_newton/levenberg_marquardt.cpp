#include "levenberg_marquardt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace submap_slam::grid_joining {
namespace {

constexpr double kDampingUp = 10, kDampingDown = 0.1, kSmallestDamping = 1e-9;

/** How much lower the trial is than `now`, as the problem wants it judged; negative if higher. */
double decrease(const LevelProblem& problem, const Evaluation& now, const Evaluation& trial) {
  if (!problem.per_overlap) return now.objective - trial.objective;
  return now.objective - objectiveAtOverlap(trial, problem.evidence_variance, now.evidence.overlap_weight);
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
  Evaluation e{reduce(problem.level, frames, problem.jacobian, problem.lattice_angle),
               problem.prior.linearise(frames), PoseSystem(frames.size())};
  e.prior_cost = problem.prior.cost(frames);
  e.objective = e.evidence.cost / problem.evidence_variance + e.prior_cost;
  e.total.add(e.evidence.system, 1 / problem.evidence_variance);
  e.total.add(e.prior, 1);
  return e;
}

double objectiveAtOverlap(const Evaluation& evaluation, double evidence_variance, double overlap_weight) {
  if (evaluation.evidence.overlap_weight <= 0) return std::numeric_limits<double>::infinity();
  const double scale = overlap_weight / evaluation.evidence.overlap_weight;
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

LevelResult optimise(const LevelProblem& problem, const Frames& start,
                     const LevenbergMarquardtOptions& options, const IterationCallback& callback) {
  LevelResult now{start, evaluate(problem, start), {}, StopReason::kIterationLimit};
  const std::vector<bool> held = anchorsOf(now.evaluation.total);
  double damping = options.first_damping;
  for (int k = 0; k < options.max_iterations; ++k) {
    const auto step = dampedStep(problem, options, now.frames, now.evaluation, held, damping);
    Frames trial_frames = step ? moved(now.frames, *step) : now.frames;
    Evaluation trial = step ? evaluate(problem, trial_frames) : now.evaluation;
    const double gain = decrease(problem, now.evaluation, trial);
    JoinIteration iteration = step ? describe(*step, std::min(now.evaluation.objective, trial.objective))
                                   : JoinIteration{0, now.evaluation.objective, 0, 0};
    const bool small_step =
        step && iteration.max_step_m < options.max_step_m && iteration.max_step_rad < options.max_step_rad;
    const bool small_decrease = gain > 0 && gain < options.cost_decrease * now.evaluation.objective;
    if (gain > 0) {
      now.frames = std::move(trial_frames);
      now.evaluation = std::move(trial);
      damping = std::max(kSmallestDamping, damping * kDampingDown);
    } else {
      damping *= kDampingUp;
    }
    now.iterations.push_back(iteration);
    if (callback && !callback(iteration)) return now.stop = StopReason::kCancelled, now;
    if (small_step) return now.stop = StopReason::kSmallStep, now;
    if (small_decrease) return now.stop = StopReason::kSmallDecrease, now;
    if (damping > options.largest_damping) return now.stop = StopReason::kNoDescent, now;
  }
  return now;
}

}  // namespace submap_slam::grid_joining
