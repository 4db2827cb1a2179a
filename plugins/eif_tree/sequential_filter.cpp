#include "sequential_filter.h"

#include <algorithm>

namespace submap_slam::landmark_joining {
namespace {

/** Adds the variables that submap k brings, as it sees them. */
void addVariables(const Observation& observation, const std::vector<int>& landmarks, JointState& state) {
  const Pose start = startOf(state, state.ends.size());
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const auto index = static_cast<std::size_t>(landmarks[i]);
    if (index < state.landmarks.size()) continue;
    state.landmarks.resize(std::max(state.landmarks.size(), index + 1));
    state.landmarks[index] =
        compose(start, Point(observation.z.segment<2>(3 + 2 * static_cast<Eigen::Index>(i))));
  }
  state.ends.push_back(compose(start, Pose(observation.z.head<3>())));
}

/** The part of the state that submap k holds, in the rows of its Contribution. */
Eigen::VectorXd localState(const JointProblem& problem, const JointState& state, std::size_t k) {
  const auto& landmarks = problem.landmarks[k];
  Eigen::VectorXd x(6 + 2 * static_cast<Eigen::Index>(landmarks.size()));
  x.head<3>() = startOf(state, k);
  x.segment<3>(3) = state.ends[k];
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    x.segment<2>(6 + 2 * static_cast<Eigen::Index>(i)) =
        state.landmarks[static_cast<std::size_t>(landmarks[i])];
  return x;
}

}  // namespace

bool SequentialFilter::fuse(const Observation& observation, const std::vector<int>& landmarks) {
  extend(observation, landmarks);
  const JointState predicted = state_;
  freeze(problem_.submaps() - 1);
  if (!solveFrozen()) return false;
  if (!options_.relinearise) return true;
  const Change change = changeBetween(predicted, state_);
  if (change.metres <= options_.relinearise_above_m && change.radians <= options_.relinearise_above_rad)
    return true;
  const auto result = minimise(problem_, *form_, state_, options_.gauss_newton, {});
  for (std::size_t k = 0; k < problem_.submaps(); ++k) freeze(k);
  return result.status != JoinStatus::kFailed;
}

void SequentialFilter::extend(const Observation& observation, const std::vector<int>& landmarks) {
  addVariables(observation, landmarks, state_);
  problem_.observations.push_back(&observation);
  problem_.landmarks.push_back(landmarks);
  problem_.landmark_count = state_.landmarks.size();
  frozen_.emplace_back();
}

/** (13) and (16) of a submap: I_k = HᵀQ⁻¹H, i_k = HᵀQ⁻¹[z − h(X) + HX], at the state as it is now. */
void SequentialFilter::freeze(std::size_t k) {
  Contribution c = linearise(problem_, state_, k);
  c.vector += c.matrix * localState(problem_, state_, k);
  frozen_[k] = std::move(c);
}

/** I = Σ I_k, i = Σ i_k, X = I⁻¹ i. */
bool SequentialFilter::solveFrozen() {
  form_ = std::make_unique<InformationForm>(problem_);
  form_->sum(frozen_);
  if (!form_->factorize()) return false;
  JointState zero;
  zero.ends.assign(state_.ends.size(), Pose::Zero());
  zero.landmarks.assign(state_.landmarks.size(), Point::Zero());
  state_ = form_->moved(zero, form_->step());
  return true;
}

}  // namespace submap_slam::landmark_joining
