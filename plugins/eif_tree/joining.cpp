#include "joining.h"

#include <fmt/format.h>

#include <utility>

#include "dense_filter.h"
#include "sequential_filter.h"
#include "tree.h"

namespace submap_slam::landmark_joining {
namespace {

using Progress = std::function<bool(double)>;

Joining failed(const JointProblem& problem, const std::string& reason) {
  Joining joining;
  joining.state = chainedState(problem);
  joining.covariances.ends.assign(problem.submaps(), Eigen::Matrix3d::Zero());
  joining.covariances.landmarks.assign(problem.landmark_count, Eigen::Matrix2d::Zero());
  joining.result.status = JoinStatus::kFailed;
  joining.result.reason = reason;
  joining.result.objective = objective(problem, joining.state);
  return joining;
}

Joining finished(const JointProblem& problem, JointState state, Covariances covariances,
                 const std::string& reason) {
  Joining joining;
  joining.result.reason = reason;
  joining.result.objective = objective(problem, state);
  joining.state = std::move(state);
  joining.covariances = std::move(covariances);
  return joining;
}

const char* const kNotDefinite = "the information matrix is not positive definite";

/** Part of a progress: shares from `from` to `to`. */
Progress between(const Progress& progress, double from, double to) {
  return [&progress, from, to](double share) { return !progress || progress(from + (to - from) * share); };
}

Joining byTree(const JoiningOptions& options, const JointProblem& problem, const Progress& progress) {
  const bool then_gauss_newton = options.method == Method::kTreeThenGaussNewton;
  constexpr double kTreeShare = 0.7;  // of the time
  auto start = joinTree(problem, {options.steps_per_join, !then_gauss_newton},
                        between(progress, 0, then_gauss_newton ? kTreeShare : 1));
  if (!start) return failed(problem, kNotDefinite);
  if (then_gauss_newton)
    return joinFrom(std::move(*start), problem, options.gauss_newton, between(progress, kTreeShare, 1));
  InformationForm form(problem);
  form.lineariseAll(*start);
  if (!form.factorize()) return failed(problem, kNotDefinite);
  return finished(problem, std::move(*start), marginalCovariances(problem, form), "the tree is joined");
}

Joining sequentially(const JoiningOptions& options, const JointProblem& problem, const Progress& progress) {
  SequentialOptions sequential;
  sequential.relinearise = options.method == Method::kSequentialIterated;
  sequential.relinearise_above = options.relinearise_above;
  sequential.gauss_newton = options.gauss_newton;
  SequentialFilter filter(sequential);
  // Landmarks are numbered as they come in the filter.
  std::vector<int> order, index(problem.landmark_count, -1);
  for (std::size_t k = 0; k < problem.submaps(); ++k) {
    std::vector<int> landmarks;
    for (const int landmark : problem.landmarks[k]) {
      int& own = index[static_cast<std::size_t>(landmark)];
      if (own < 0) own = static_cast<int>(order.size()), order.push_back(landmark);
      landmarks.push_back(own);
    }
    if (!filter.fuse(*problem.observations[k], landmarks)) return failed(problem, kNotDefinite);
    const double share = static_cast<double>(k + 1) / static_cast<double>(problem.submaps());
    if (progress && !progress(share * share)) return failed(problem, "stopped before all submaps were fused");
  }
  const Covariances by_arrival = marginalCovariances(filter.problem(), *filter.form());
  JointState state = filter.state();
  Covariances covariances = by_arrival;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto landmark = static_cast<std::size_t>(order[i]);
    state.landmarks[landmark] = filter.state().landmarks[i];
    covariances.landmarks[landmark] = by_arrival.landmarks[i];
  }
  return finished(problem, std::move(state), std::move(covariances), "all submaps are fused");
}

Joining densely(const JointProblem& problem, const Progress& progress) {
  auto estimate = joinDense(problem, progress);
  if (!estimate)
    return failed(problem, fmt::format("the dense filter was stopped, has more than {} elements or is not "
                                       "positive definite",
                                       kLargestDenseState));
  return finished(problem, std::move(estimate->state), std::move(estimate->covariances),
                  "all submaps are fused");
}

}  // namespace

Joining joinFrom(JointState start, const JointProblem& problem, const GaussNewtonOptions& options,
                 const Progress& progress) {
  InformationForm form(problem);
  Joining joining;
  joining.state = std::move(start);
  double done = 0;
  const auto report = [&](const JoinIteration&) {
    constexpr double kUsualIterations = 5;
    ++done;
    return !progress || progress(done / (done + kUsualIterations));
  };
  joining.result = minimise(problem, form, joining.state, options, report);
  if (joining.result.status == JoinStatus::kFailed) return failed(problem, joining.result.reason);
  joining.covariances = marginalCovariances(problem, form);
  return joining;
}

Joining joinBy(const JoiningOptions& options, const JointProblem& problem, const Progress& progress) {
  switch (options.method) {
    case Method::kSequential:
    case Method::kSequentialIterated:
      return sequentially(options, problem, progress);
    case Method::kDenseFilter:
      return densely(problem, progress);
    default:
      return byTree(options, problem, progress);
  }
}

}  // namespace submap_slam::landmark_joining
