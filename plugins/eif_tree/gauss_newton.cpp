#include "gauss_newton.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace submap_slam::landmark_joining {
namespace {

/** Moves the state by the step or, where that raises the objective, by the half, quarter, …; returns the new
 * objective, or nothing if even a tiny part of the step raises it. */
std::optional<double> descend(const JointProblem& problem, const InformationForm& form,
                              const Eigen::VectorXd& step, double before, JointState& state) {
  constexpr int kMostHalvings = 12;
  constexpr double kRounding = 1e-10;  // a full step at the minimum changes the objective by rounding only
  double share = 1;
  for (int i = 0; i <= kMostHalvings; ++i, share /= 2) {
    JointState candidate = form.moved(state, step, share);
    const double cost = objective(problem, candidate);
    if (!(cost <= before * (1 + kRounding) + kRounding)) continue;
    state = std::move(candidate);
    return cost;
  }
  return std::nullopt;
}

}  // namespace

GaussNewtonResult minimise(const JointProblem& problem, InformationForm& form, JointState& state,
                           const GaussNewtonOptions& options, const IterationCallback& callback) {
  GaussNewtonResult result;
  const auto end = [&](JoinStatus status, const std::string& reason) {
    result.status = status;
    result.reason = reason;
    return result;
  };
  result.objective = objective(problem, state);
  if (!std::isfinite(result.objective)) return end(JoinStatus::kFailed, "the objective is not finite");
  for (int i = 0; i < options.max_iterations; ++i) {
    const double before = form.lineariseAll(state);
    if (!form.factorize()) return end(JoinStatus::kFailed, "the information matrix is not positive definite");
    const JointState old = state;
    const auto cost = descend(problem, form, form.step(), before, state);
    if (!cost) return end(JoinStatus::kConverged, "no step lowers the objective");
    const Change change = changeBetween(old, state);
    result.objective = *cost;
    result.iterations.push_back({0, *cost, change.metres, change.radians});
    if (change.metres <= options.max_step_m && change.radians <= options.max_step_rad)
      return end(JoinStatus::kConverged, "steps are below their tolerances");
    if (callback && !callback(result.iterations.back()))
      return end(JoinStatus::kIterationLimit, "stopped before it had converged");
  }
  return end(JoinStatus::kIterationLimit, fmt::format("{} iterations", options.max_iterations));
}

}  // namespace submap_slam::landmark_joining
