#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "constraint_prior.h"
#include "reduced_system.h"

namespace submap_slam::grid_joining {

/** What is minimised at one level: F(X) = cost(X) / evidence_variance + prior(X). */
struct LevelProblem {
  const EvidenceLevels& level;
  const ConstraintPrior& prior;
  JacobianKind jacobian = JacobianKind::kVariableProjection;
  double lattice_angle = 0;      ///< rad
  double evidence_variance = 1;  ///< variance of one residual of the evidence, see estimateEvidenceVariance

  /** Judge a step by the cost per overlap instead of the cost: needed where frames are far off, because
   * frames that drift apart have less overlap and so less cost. */
  bool per_overlap = false;

  bool single_precision = true;  ///< of the sums over the cells of a tile, see reduce()
};

/** F and its normal equations at one set of frames. */
struct Evaluation {
  ReducedSystem evidence;
  PoseSystem prior;  ///< normal equations of the prior alone
  PoseSystem total;  ///< evidence / evidence_variance + prior
  double prior_cost = 0;
  double objective = 0;  ///< F
  double overlap = 0;    ///< overlapWeight at these frames, if the problem asks for it
};
Evaluation evaluate(const LevelProblem& problem, const Frames& frames);

/** Weighs evidence and prior of an evaluation anew after the problem's evidence variance has changed. */
void weigh(const LevelProblem& problem, Evaluation& evaluation);

/** F with the evidence scaled to the given overlap, to compare frames whose overlap differs; infinite without
 * overlap. The evaluation must be that of a problem with `per_overlap`. */
double objectiveAtOverlap(const Evaluation& evaluation, double evidence_variance, double overlap);

/** Variance of one evidence residual from the residuals themselves, cost / (observations − cells), times the
 * number of cells that err together, (correlation_length / cell size)²: neighbouring cells share beams,
 * matching errors and drift, so they are not independent witnesses. Never below (1 % of the evidence)², so
 * that perfect evidence keeps a finite weight. */
double estimateEvidenceVariance(const ReducedSystem& evidence, double cell_size_m,
                                double correlation_length_m);

/** Another way to find the step: from frames, what is added to the normal equations (in units of the evidence
 * cost), and held frames to Δ. */
using StepFunction = std::function<std::optional<Eigen::VectorXd>(
    const Frames& frames, const PoseSystem& pose_terms, const std::vector<bool>& held)>;

struct LevenbergMarquardtOptions {
  int max_iterations = 40;
  double max_step_m = 2e-4;      ///< converged when no frame moves farther …
  double max_step_rad = 1e-5;    ///< … nor turns more
  double cost_decrease = 1e-6;   ///< converged when the objective falls by a smaller share
  double first_damping = 1e-3;   ///< share of the diagonal that is added to it
  double largest_damping = 1e6;  ///< give up beyond
  StepFunction step;             ///< empty: solve the reduced system
};

enum class StopReason { kSmallStep, kSmallDecrease, kNoDescent, kIterationLimit, kCancelled };
const char* toString(StopReason reason);

struct LevelResult {
  Frames frames;
  Evaluation evaluation;  ///< at `frames`
  std::vector<JoinIteration> iterations;
  StopReason stop = StopReason::kIterationLimit;
};

/** Called after each iteration with the frames it led to; false stops. */
using IterationCallback = std::function<bool(const JoinIteration&, const Frames&)>;

/** Gauss-Newton with Levenberg-Marquardt damping: a step is taken only if it lowers the objective, so the
 * result is never worse than the start. The first frame of every connected group stays where it is.
 * @param at_start the evaluation at `start` */
LevelResult optimise(const LevelProblem& problem, const Frames& start, const Evaluation& at_start,
                     const LevenbergMarquardtOptions& options, const IterationCallback& callback);

}  // namespace submap_slam::grid_joining
