#pragma once

#include <submap_slam/core/joined_map.h>

#include <functional>
#include <string>

#include "information_form.h"

namespace submap_slam::landmark_joining {

struct GaussNewtonOptions {
  int max_iterations = 50;
  double max_step_m = 1e-4, max_step_rad = 1e-6;  ///< converged when no variable moves more
};

struct GaussNewtonResult {
  JoinStatus status = JoinStatus::kChained;
  std::string reason;
  double objective = 0;
  std::vector<JoinIteration> iterations;
};

/** Called after each iteration; false ends them. */
using IterationCallback = std::function<bool(const JoinIteration&)>;

/** Minimises the objective over all submaps, relinearised in each iteration (Iterated SLSJF; Huang, Wang,
 * Dissanayake, Frese 2008). A step that would raise the objective is halved. `form` belongs to `problem` and
 * is left factorized at the last state but one, or at the start if no step was needed. */
GaussNewtonResult minimise(const JointProblem& problem, InformationForm& form, JointState& state,
                           const GaussNewtonOptions& options, const IterationCallback& callback);

}  // namespace submap_slam::landmark_joining
