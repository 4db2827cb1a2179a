#include "joining.h"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "chaining.h"
#include "dense_filter.h"
#include "sequential_filter.h"

namespace submap_slam::landmark_joining {
namespace {

using Progress = std::function<bool(double)>;

Joining joiningOf(const JointProblem& problem, Estimate estimate, JoinStatus status,
                  const std::string& reason) {
  Joining joining;
  joining.result.status = status;
  joining.result.reason = reason;
  joining.result.objective = objective(problem, estimate.state);
  joining.state = std::move(estimate.state);
  joining.covariances = std::move(estimate.covariances);
  return joining;
}

Joining failed(const JointProblem& problem, const std::string& reason) {
  return joiningOf(problem, chained(problem), JoinStatus::kFailed, reason);
}

/** The estimate of a filter that fused all submaps, or was stopped after the first ones. */
Joining fused(const JointProblem& problem, Estimate estimate) {
  const std::size_t count = estimate.state.ends.size();
  if (count == problem.submaps())
    return joiningOf(problem, std::move(estimate), JoinStatus::kConverged, "all submaps are fused");
  chainOn(problem, estimate);
  return joiningOf(
      problem, std::move(estimate), JoinStatus::kIterationLimit,
      fmt::format("stopped after {} of {} submaps; the others are chained", count, problem.submaps()));
}

const char* const kNotDefinite = "the information matrix is not positive definite";

/** Part of a progress: shares from `from` to `to`. */
Progress between(const Progress& progress, double from, double to) {
  return [&progress, from, to](double share) { return !progress || progress(from + (to - from) * share); };
}

Joining sequentially(const JoiningOptions& options, const JointProblem& problem, const Progress& progress) {
  SequentialOptions sequential;
  sequential.relinearise = options.method == Method::kSequentialIterated;
  sequential.relinearise_above_m = sequential.relinearise_above_rad = options.relinearise_above;
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
    if (progress && !progress(share * share)) break;
  }
  const Covariances by_arrival = marginalCovariances(filter.problem(), *filter.form());
  Estimate estimate{{filter.state().ends, {}}, {by_arrival.ends, {}}};
  estimate.state.landmarks.assign(problem.landmark_count, Point::Zero());
  estimate.covariances.landmarks.assign(problem.landmark_count, Eigen::Matrix2d::Zero());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto landmark = static_cast<std::size_t>(order[i]);
    estimate.state.landmarks[landmark] = filter.state().landmarks[i];
    estimate.covariances.landmarks[landmark] = by_arrival.landmarks[i];
  }
  return fused(problem, std::move(estimate));
}

Joining densely(const JointProblem& problem, const Progress& progress) {
  const std::size_t size = stateSize(problem);
  if (size > kLargestDenseState)
    return failed(problem,
                  fmt::format("the state has {} elements, too large for the dense filter, which takes {}",
                              size, kLargestDenseState));
  auto estimate = joinDense(problem, progress);
  if (!estimate) return failed(problem, "the covariance of an innovation is not positive definite");
  return fused(problem, std::move(*estimate));
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

JoiningTree treeFor(const JoiningOptions& options) {
  return JoiningTree({options.steps_per_join, options.method != Method::kTreeThenGaussNewton});
}

Joining joinByTree(JoiningTree& tree, const std::vector<uint32_t>& ids, const JoiningOptions& options,
                   const JointProblem& problem, const Progress& progress) {
  const bool then_gauss_newton = options.method == Method::kTreeThenGaussNewton;
  constexpr double kTreeShare = 0.7;  // of the time
  auto start = tree.join(problem, ids, between(progress, 0, then_gauss_newton ? kTreeShare : 1));
  if (!start) return failed(problem, kNotDefinite);
  if (then_gauss_newton)
    return joinFrom(std::move(start->state), problem, options.gauss_newton, between(progress, kTreeShare, 1));
  InformationForm form(problem);
  form.lineariseAll(start->state);
  if (!form.factorize()) return failed(problem, kNotDefinite);
  Estimate estimate{std::move(start->state), marginalCovariances(problem, form)};
  if (start->stopped)
    return joiningOf(problem, std::move(estimate), JoinStatus::kIterationLimit,
                     "stopped before the tree was joined");
  return joiningOf(problem, std::move(estimate), JoinStatus::kConverged, "the tree is joined");
}

Joining joinBy(const JoiningOptions& options, const JointProblem& problem, const Progress& progress) {
  switch (options.method) {
    case Method::kSequential:
    case Method::kSequentialIterated:
      return sequentially(options, problem, progress);
    case Method::kDenseFilter:
      return densely(problem, progress);
    default: {
      JoiningTree tree = treeFor(options);
      std::vector<uint32_t> ids(problem.landmark_count);
      std::iota(ids.begin(), ids.end(), 0U);
      return joinByTree(tree, ids, options, problem, progress);
    }
  }
}

}  // namespace submap_slam::landmark_joining
