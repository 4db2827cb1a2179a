#include "coarse_to_fine.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "full_gauss_newton.h"

namespace submap_slam::grid_joining {
namespace {

/** Less than this share above the start counts as equally good: frames that were optimal stay accepted. */
constexpr double kEquallyGood = 1e-3;

/** Coarse levels give up soon: their Jacobian is not the gradient of the cost, so a smaller step need not
 * lower it, and the next level does better. */
constexpr double kLargestCoarseDamping = 0.05;

double cellSize(const EvidenceLevels& level) {
  const auto observed = std::find_if(level.begin(), level.end(), [](const auto& l) { return !l.empty(); });
  return observed == level.end() ? 1 : observed->resolution();
}

StepFunction stepFunction(SolverKind solver, const LevelProblem& problem) {
  if (solver == SolverKind::kPoseOnly) return {};
  return [solver, &problem](const Frames& frames, const PoseSystem& pose_terms,
                            const std::vector<bool>& held) -> std::optional<Eigen::VectorXd> {
    const ExplicitProblem written = writeOut(problem.level, frames, problem.jacobian, problem.lattice_angle);
    if (solver == SolverKind::kExplicitPoseOnly) return poseOnlyStep(written, pose_terms, held);
    const auto step = fullStep(written, Eigen::VectorXd::Zero(written.map_jacobian.cols()), pose_terms, held);
    if (!step) return std::nullopt;
    return step->frames;
  };
}

CoarseToFineResult nothingToJoin(const Frames& start) {
  CoarseToFineResult result;
  result.reason = "no two submaps overlap";
  result.frames = start;
  result.covariances.resize(start.size());
  return result;
}

CoarseToFineResult failed(const Frames& start, double objective, std::vector<JoinIteration> iterations) {
  CoarseToFineResult result;
  result.status = JoinStatus::kFailed;
  result.reason = "no frames were found that fit better than those given";
  result.frames = start;
  result.objective = objective;
  result.iterations = std::move(iterations);
  result.covariances.resize(start.size());
  return result;
}

/** Frames with what the finest level says about them. */
struct Candidate {
  Frames frames;
  Evaluation finest;
};

/** The schedule and what it needs at every level. */
class Schedule {
 public:
  Schedule(const std::vector<EvidenceLevels>& pyramid, const ConstraintPrior& prior,
           const CoarseToFineOptions& options, const IterationCallback& callback)
      : pyramid_(pyramid), prior_(prior), options_(options), callback_(callback) {}

  CoarseToFineResult run(const Frames& start);

 private:
  LevelProblem problemAt(std::size_t k, JacobianKind jacobian) const;
  void estimateVariance(LevelProblem& problem, Evaluation& at_start) const;
  LevelResult optimiseLevel(std::size_t k, const LevelProblem& problem, const Frames& start,
                            const Evaluation& at_start);
  LevelResult optimiseCoarse(std::size_t k, const Frames& start);
  bool descend(const LevelProblem& finest, Candidate& best);
  bool descendOnce(const LevelProblem& finest, Candidate& best);
  bool movedFar(const Frames& before, const Frames& after) const;
  CoarseToFineResult conclude(const LevelResult& finest, double evidence_variance);

  const std::vector<EvidenceLevels>& pyramid_;
  const ConstraintPrior& prior_;
  const CoarseToFineOptions& options_;
  const IterationCallback& callback_;
  std::vector<JoinIteration> iterations_;
};

LevelProblem Schedule::problemAt(std::size_t k, JacobianKind jacobian) const {
  LevelProblem problem{pyramid_[k], prior_};
  problem.jacobian = jacobian;
  problem.lattice_angle = options_.lattice_angle;
  problem.per_overlap = k > 0;
  problem.single_precision = options_.solver == SolverKind::kPoseOnly;
  return problem;
}

void Schedule::estimateVariance(LevelProblem& problem, Evaluation& at_start) const {
  problem.evidence_variance =
      estimateEvidenceVariance(at_start.evidence, cellSize(problem.level), options_.correlation_length);
  weigh(problem, at_start);
}

LevelResult Schedule::optimiseLevel(std::size_t k, const LevelProblem& problem, const Frames& start,
                                    const Evaluation& at_start) {
  LevenbergMarquardtOptions iteration = options_.iteration;
  const double cells =
      static_cast<double>(std::size_t{1} << k);  // a coarse result is a start for the next level only
  iteration.max_step_m *= cells;
  iteration.max_step_rad *= cells;
  iteration.cost_decrease *= cells;
  if (k > 0) iteration.largest_damping = kLargestCoarseDamping;
  iteration.step = stepFunction(options_.solver, problem);
  return optimise(problem, start, at_start, iteration, [&](JoinIteration i, const Frames& frames) {
    i.level = static_cast<int>(k);
    iterations_.push_back(i);
    return !callback_ || callback_(i, frames);
  });
}

/** First along the coarse Jacobian for its wide basin, then along that of the finest level: the fixed point
 * of the first is biased. */
LevelResult Schedule::optimiseCoarse(std::size_t k, const Frames& start) {
  LevelProblem problem = problemAt(k, options_.coarse_jacobian);
  Evaluation at_start = evaluate(problem, start);
  estimateVariance(problem, at_start);
  LevelResult level = optimiseLevel(k, problem, start, at_start);
  if (level.stop == StopReason::kCancelled || options_.coarse_jacobian == options_.finest_jacobian)
    return level;
  problem.jacobian = options_.finest_jacobian;
  return optimiseLevel(k, problem, level.frames, evaluate(problem, level.frames));
}

/** Whether a frame moved by more than half a cell of the coarsest level. */
bool Schedule::movedFar(const Frames& before, const Frames& after) const {
  const double far = 0.5 * cellSize(pyramid_.back());
  for (std::size_t i = 0; i < before.size(); ++i)
    if (std::hypot(after[i].x - before[i].x, after[i].y - before[i].y) > far) return true;
  return false;
}

/** From the coarsest level to the one above the finest, and once more if that moved frames far: submaps that
 * start far off mislead each other through the joint values of cells, and then fewer of them are off. False
 * if it was stopped on request. */
bool Schedule::descend(const LevelProblem& finest, Candidate& best) {
  const Frames start = best.frames;
  if (!descendOnce(finest, best)) return false;
  return !movedFar(start, best.frames) || descendOnce(finest, best);
}

bool Schedule::descendOnce(const LevelProblem& finest, Candidate& best) {
  const double overlap = best.finest.overlap;
  double lowest = best.finest.objective;
  for (std::size_t k = pyramid_.size() - 1; k > 0; --k) {
    const LevelResult level = optimiseCoarse(k, best.frames);
    Candidate candidate{level.frames, evaluate(finest, level.frames)};
    const double objective = objectiveAtOverlap(candidate.finest, finest.evidence_variance, overlap);
    if (objective < lowest) {
      lowest = objective;
      best = std::move(candidate);
    }
    if (level.stop == StopReason::kCancelled) return false;
  }
  return true;
}

CoarseToFineResult Schedule::conclude(const LevelResult& finest, double evidence_variance) {
  CoarseToFineResult result;
  result.iterations = std::move(iterations_);
  const bool unfinished = finest.stop == StopReason::kIterationLimit || finest.stop == StopReason::kCancelled;
  result.status = unfinished ? JoinStatus::kIterationLimit : JoinStatus::kConverged;
  result.reason = toString(finest.stop);
  result.frames = finest.frames;
  result.objective = finest.evaluation.objective;
  const PoseSystem& system = finest.evaluation.total;
  result.groups = groupsOf(system);
  const auto covariances = marginalCovariances(system, anchorsOf(system), dampingDiagonal(system, 0));
  result.covariances.resize(finest.frames.size());
  if (!covariances) return result;
  for (std::size_t i = 0; i < result.groups.size(); ++i)
    if (result.groups[i] == 0) result.covariances[i] = (*covariances)[i];
  result.open_directions =
      openDirections(finest.evaluation, evidence_variance, *covariances, cellSize(pyramid_.front()));
  return result;
}

CoarseToFineResult Schedule::run(const Frames& start) {
  LevelProblem comparison = problemAt(0, options_.finest_jacobian);
  comparison.per_overlap = true;
  Candidate best{start, evaluate(comparison, start)};
  if (best.finest.overlap <= 0) return nothingToJoin(start);
  estimateVariance(comparison, best.finest);
  const double before = best.finest.objective, overlap = best.finest.overlap;
  const bool finished = descend(comparison, best);

  LevelProblem problem = problemAt(0, options_.finest_jacobian);
  estimateVariance(problem, best.finest);
  LevelResult finest{best.frames, best.finest, {}, StopReason::kCancelled};
  if (finished) finest = optimiseLevel(0, problem, best.frames, best.finest);

  finest.evaluation.overlap =
      overlapWeight(PlacedLevels(pyramid_.front(), finest.frames, options_.lattice_angle));
  const double after = objectiveAtOverlap(finest.evaluation, comparison.evidence_variance, overlap);
  if (after > before * (1 + kEquallyGood)) return failed(start, before, std::move(iterations_));
  return conclude(finest, problem.evidence_variance);
}

}  // namespace

CoarseToFineResult joinCoarseToFine(const std::vector<EvidenceLevels>& pyramid, const Frames& start,
                                    const ConstraintPrior& prior, const CoarseToFineOptions& options,
                                    const IterationCallback& callback) {
  return Schedule(pyramid, prior, options, callback).run(start);
}

}  // namespace submap_slam::grid_joining
