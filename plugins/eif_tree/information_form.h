#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "block_pattern.h"
#include "sparse_cholesky.h"

namespace submap_slam::landmark_joining {

/** Information matrix I and vector of a joint problem, summed from the contributions of its submaps, and its
 * solution. Pattern, order and symbolic analysis are made once. */
class InformationForm {
 public:
  explicit InformationForm(const JointProblem& problem);

  /** Sums the contributions of all submaps. */
  void sum(const std::vector<Contribution>& contributions);

  /** Sums the contributions of all submaps, each linearised at the state; returns the objective there. */
  double lineariseAll(const JointState& state);

  /** False if the matrix is not positive definite. */
  bool factorize() { return cholesky_.factorize(matrix_); }

  /** I⁻¹ times the vector; after factorize(). Read it by moved(). */
  Eigen::VectorXd step() { return cholesky_.solve(vector_); }

  /** The state moved by a share of the step. */
  JointState moved(const JointState& state, const Eigen::VectorXd& step, double share = 1) const;

  const BlockPattern& pattern() const { return pattern_; }
  SparseCholesky& cholesky() { return cholesky_; }
  const SparseCholesky& cholesky() const { return cholesky_; }
  const Eigen::SparseMatrix<double>& matrix() const { return matrix_; }

 private:
  void clear();
  void add(std::size_t k, const Contribution& contribution);
  template <class BelowTop>
  void addColumn(const Contribution& contribution, const std::vector<int>& rows, std::size_t part,
                 const BelowTop& below_top);

  const JointProblem& problem_;
  BlockPattern pattern_;
  Eigen::SparseMatrix<double> matrix_;  // upper triangle
  Eigen::VectorXd vector_;
  SparseCholesky cholesky_;
};

/** Largest change of a position (m) and of a heading (rad) between two states. */
struct Change {
  double metres = 0, radians = 0;
};
Change changeBetween(const JointState& a, const JointState& b);

}  // namespace submap_slam::landmark_joining
