#include "block_pattern.h"

#include <amd.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace submap_slam::landmark_joining {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

std::vector<int> variablesOf(const JointProblem& problem, std::size_t k) {
  std::vector<int> variables;
  const auto poses = static_cast<int>(problem.submaps());
  if (k > 0) variables.push_back(static_cast<int>(k) - 1);
  variables.push_back(static_cast<int>(k));
  for (const int landmark : problem.landmarks[k]) variables.push_back(poses + landmark);
  return variables;
}

BlockPattern::BlockPattern(const JointProblem& problem)
    : poses_(problem.submaps()), row_of_(problem.submaps() + problem.landmark_count) {
  const Neighbours neighbours = findNeighbours(problem);
  order_ = eliminationOrder(neighbours);
  for (const int variable : order_) {
    row_of_[at(variable)] = size_;
    size_ += rowsIn(variable);
  }
  std::vector<std::vector<int>> above(row_of_.size());  // in the order of their rows, as they come
  for (const int variable : order_) {
    above[at(variable)].push_back(variable);
    for (const int other : neighbours[at(variable)])
      if (row_of_[at(other)] > row_of_[at(variable)]) above[at(other)].push_back(variable);
  }
  above_.reserve(order_.size());
  for (const int variable : order_) above_.push_back(std::move(above[at(variable)]));
}

BlockPattern::Neighbours BlockPattern::findNeighbours(const JointProblem& problem) const {
  std::vector<std::vector<int>> submaps_of(row_of_.size()), members;
  for (std::size_t k = 0; k < problem.submaps(); ++k) {
    members.push_back(variablesOf(problem, k));
    for (const int variable : members.back()) submaps_of[at(variable)].push_back(static_cast<int>(k));
  }
  Neighbours neighbours(row_of_.size());
  std::vector<int> seen_from(row_of_.size(), -1);
  for (int variable = 0; variable < variables(); ++variable) {
    seen_from[at(variable)] = variable;
    for (const int k : submaps_of[at(variable)])
      for (const int other : members[at(k)])
        if (std::exchange(seen_from[at(other)], variable) != variable)
          neighbours[at(variable)].push_back(other);
  }
  return neighbours;
}

std::vector<int> BlockPattern::eliminationOrder(const Neighbours& neighbours) const {
  std::vector<int> start{0}, index, order(row_of_.size());
  for (const auto& list : neighbours) {
    index.insert(index.end(), list.begin(), list.end());
    start.push_back(static_cast<int>(index.size()));
  }
  if (index.empty()) index.push_back(0);  // AMD wants an address
  double control[AMD_CONTROL], info[AMD_INFO];
  amd_defaults(control);
  if (amd_order(variables(), start.data(), index.data(), order.data(), control, info) < AMD_OK)
    throw std::runtime_error("AMD found no elimination order");
  return order;
}

Eigen::SparseMatrix<double> BlockPattern::upperTriangle() const {
  Eigen::SparseMatrix<double> matrix(size_, size_);
  Eigen::VectorXi counts(size_);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const int width = rowsIn(order_[i]), column = row_of_[at(order_[i])];
    int rows = -width;
    for (const int variable : above_[i]) rows += rowsIn(variable);
    for (int c = 0; c < width; ++c) counts[column + c] = rows + c + 1;
  }
  matrix.resizeNonZeros(counts.sum());
  int entry = 0;
  for (std::size_t i = 0; i < order_.size(); ++i)
    for (int c = 0; c < rowsIn(order_[i]); ++c) {
      const int column = row_of_[at(order_[i])] + c;
      matrix.outerIndexPtr()[column] = entry;
      for (const int variable : above_[i]) {
        const int row = row_of_[at(variable)];
        for (int r = row; r < std::min(row + rowsIn(variable), column + 1); ++r)
          matrix.innerIndexPtr()[entry++] = r;
      }
    }
  matrix.outerIndexPtr()[size_] = entry;
  return matrix;
}

std::vector<int> BlockPattern::rowsOf(const JointProblem& problem, std::size_t k) const {
  std::vector<int> rows;
  if (k == 0) rows.push_back(-1);
  for (const int variable : variablesOf(problem, k)) rows.push_back(row_of_[at(variable)]);
  return rows;
}

}  // namespace submap_slam::landmark_joining
