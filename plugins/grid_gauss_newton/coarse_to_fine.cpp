#include "coarse_to_fine.h"

#include <algorithm>
#include <utility>

#include "full_gauss_newton.h"

namespace submap_slam::grid_joining {
namespace {

/** Less than this share above the start counts as equally good: frames that were optimal stay accepted. */
constexpr double kEquallyGood = 1e-3;

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

/** The schedule and what it needs at every level. */
class Schedule {
 public:
  Schedule(const std::vector<EvidenceLevels>& pyramid, const ChainPrior& prior,
           const CoarseToFineOptions& options, const IterationCallback& callback)
      : pyramid_(pyramid), prior_(prior), options_(options), callback_(callback) {}

  CoarseToFineResult run(const Frames& start);

 private:
  LevelProblem problemAt(std::size_t k, const Frames& frames) const;
  LevelResult optimiseLevel(std::size_t k, const LevelProblem& problem, const Frames& start);
  bool descend(const Frames& start);
  CoarseToFineResult conclude(const Frames& start, const LevelResult& finest);

  const std::vector<EvidenceLevels>& pyramid_;
  const ChainPrior& prior_;
  const CoarseToFineOptions& options_;
  const IterationCallback& callback_;

  Frames best_;
  std::vector<JoinIteration> iterations_;
};

LevelProblem Schedule::problemAt(std::size_t k, const Frames& frames) const {
  LevelProblem problem{pyramid_[k], prior_};
  problem.jacobian = k == 0 ? options_.finest_jacobian : options_.coarse_jacobian;
  problem.lattice_angle = options_.lattice_angle;
  problem.per_overlap = k > 0;
  const ReducedSystem evidence = reduce(problem.level, frames, problem.jacobian, problem.lattice_angle);
  problem.evidence_variance =
      estimateEvidenceVariance(evidence, cellSize(problem.level), options_.correlation_length);
  return problem;
}

LevelResult Schedule::optimiseLevel(std::size_t k, const LevelProblem& problem, const Frames& start) {
  LevenbergMarquardtOptions iteration = options_.iteration;
  const double cells =
      static_cast<double>(std::size_t{1} << k);  // a coarse result is a start for the next level only
  iteration.max_step_m *= cells;
  iteration.max_step_rad *= cells;
  iteration.step = stepFunction(options_.solver, problem);
  LevelResult result = optimise(problem, start, iteration, [&](JoinIteration i) {
    i.level = static_cast<int>(k);
    iterations_.push_back(i);
    return !callback_ || callback_(i);
  });
  return result;
}

/** Goes down to the level above the finest; false if it was stopped on request. */
bool Schedule::descend(const Frames& start) {
  best_ = start;
  const LevelProblem finest = problemAt(0, start);
  const Evaluation at_start = evaluate(finest, start);
  const double overlap = at_start.evidence.overlap_weight;
  double lowest = objectiveAtOverlap(at_start, finest.evidence_variance, overlap);
  for (std::size_t k = pyramid_.size() - 1; k > 0; --k) {
    const LevelResult level = optimiseLevel(k, problemAt(k, best_), best_);
    const double objective =
        objectiveAtOverlap(evaluate(finest, level.frames), finest.evidence_variance, overlap);
    if (objective < lowest) {
      lowest = objective;
      best_ = level.frames;
    }
    if (level.stop == StopReason::kCancelled) return false;
  }
  return true;
}

CoarseToFineResult Schedule::conclude(const Frames& start, const LevelResult& finest) {
  CoarseToFineResult result;
  result.iterations = std::move(iterations_);
  result.covariances.resize(start.size());
  const LevelProblem problem = problemAt(0, start);
  const Evaluation before = evaluate(problem, start);
  const double overlap = before.evidence.overlap_weight;
  const double after =
      objectiveAtOverlap(evaluate(problem, finest.frames), problem.evidence_variance, overlap);
  if (after > before.objective * (1 + kEquallyGood)) {
    result.status = JoinStatus::kFailed;
    result.reason = "no frames were found that fit better than those given";
    result.frames = start;
    result.objective = before.objective;
    return result;
  }

  const bool unfinished = finest.stop == StopReason::kIterationLimit || finest.stop == StopReason::kCancelled;
  result.status = unfinished ? JoinStatus::kIterationLimit : JoinStatus::kConverged;
  result.reason = toString(finest.stop);
  result.frames = finest.frames;
  result.objective = finest.evaluation.objective;
  const PoseSystem& system = finest.evaluation.total;
  const auto groups = groupsOf(system);
  const auto covariances = marginalCovariances(system, anchorsOf(system), dampingDiagonal(system, 0));
  for (std::size_t i = 0; covariances && i < groups.size(); ++i)
    if (groups[i] == 0) result.covariances[i] = (*covariances)[i];
  return result;
}

CoarseToFineResult Schedule::run(const Frames& start) {
  const bool finished = descend(start);
  const LevelProblem problem = problemAt(0, best_);
  LevelResult finest = finished ? optimiseLevel(0, problem, best_)
                                : LevelResult{best_, evaluate(problem, best_), {}, StopReason::kCancelled};
  return conclude(start, finest);
}

}  // namespace

CoarseToFineResult joinCoarseToFine(const std::vector<EvidenceLevels>& pyramid, const Frames& start,
                                    const ChainPrior& prior, const CoarseToFineOptions& options,
                                    const IterationCallback& callback) {
  const ReducedSystem overlap =
      reduce(pyramid.front(), start, options.finest_jacobian, options.lattice_angle);
  if (overlap.observations == 0) {
    CoarseToFineResult nothing;
    nothing.reason = "no two submaps overlap";
    nothing.frames = start;
    nothing.covariances.resize(start.size());
    return nothing;
  }
  return Schedule(pyramid, prior, options, callback).run(start);
}

}  // namespace submap_slam::grid_joining
