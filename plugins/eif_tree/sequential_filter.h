#pragma once

#include <memory>
#include <vector>

#include "gauss_newton.h"

namespace submap_slam::landmark_joining {

struct SequentialOptions {
  bool relinearise = true;  ///< false: each submap stays linearised where it was fused (SLSJF)
  double relinearise_above_m = 0.01, relinearise_above_rad = 0.01;  ///< when an estimate changes by more
  GaussNewtonOptions gauss_newton;
};

/** Fuses submaps one after the other: the Sparse Local Submap Joining Filter (Huang, Wang, Dissanayake 2008),
 * or its iterated form. */
class SequentialFilter {
 public:
  explicit SequentialFilter(const SequentialOptions& options) : options_(options) {}

  /** Fuses the next submap, which must outlive this object.
   * @param landmarks of its features; those that are not in the state yet follow its last one without gap
   * @return false if the information matrix is not positive definite; the state is then of no use */
  bool fuse(const Observation& observation, const std::vector<int>& landmarks);

  const JointProblem& problem() const { return problem_; }
  const JointState& state() const { return state_; }

  /** The information form of the last fusion, factorized; null before the first. */
  InformationForm* form() const { return form_.get(); }

 private:
  void extend(const Observation& observation, const std::vector<int>& landmarks);
  void freeze(std::size_t k);
  bool solveFrozen();

  SequentialOptions options_;
  JointProblem problem_;
  JointState state_;
  std::vector<Contribution> frozen_;  ///< of each submap HᵀQ⁻¹H, and HᵀQ⁻¹[z − h(X) + HX] as vector
  std::unique_ptr<InformationForm> form_;
};

}  // namespace submap_slam::landmark_joining
