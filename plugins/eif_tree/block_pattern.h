#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <vector>

#include "observation.h"

namespace submap_slam::landmark_joining {

/** Where the variables of a joint problem are in its information matrix: poses (three rows) and landmarks
 * (two rows) as blocks, ordered so that the Cholesky factor stays sparse (approximate minimum degree).
 * Variables are linked if a submap holds both, and only then (exactly sparse; Huang, Wang, Dissanayake 2008).
 */
class BlockPattern {
 public:
  explicit BlockPattern(const JointProblem& problem);

  int size() const { return size_; }
  int poseRow(std::size_t pose) const { return row_of_[pose]; }
  int landmarkRow(std::size_t landmark) const { return row_of_[poses_ + landmark]; }

  /** The upper triangle, with the entries of the pattern and no values yet. */
  Eigen::SparseMatrix<double> upperTriangle() const;

  /** First row of each part of a Contribution to submap k; −1: not in the state. */
  std::vector<int> rowsOf(const JointProblem& problem, std::size_t k) const;

 private:
  using Neighbours = std::vector<std::vector<int>>;

  int variables() const { return static_cast<int>(row_of_.size()); }
  int rowsIn(int variable) const { return static_cast<std::size_t>(variable) < poses_ ? 3 : 2; }
  Neighbours findNeighbours(const JointProblem& problem) const;
  std::vector<int> eliminationOrder(const Neighbours& neighbours) const;

  std::size_t poses_;
  int size_ = 0;
  std::vector<int> row_of_;              // of each variable: poses, then landmarks
  std::vector<int> order_;               // variables in the order of their rows
  std::vector<std::vector<int>> above_;  // for each in that order: those linked to it from the top to itself
};

/** The variables that submap k links: start pose (but the first one), end pose, landmarks. Poses count from
 * 0, landmarks from the number of poses. */
std::vector<int> variablesOf(const JointProblem& problem, std::size_t k);

}  // namespace submap_slam::landmark_joining
