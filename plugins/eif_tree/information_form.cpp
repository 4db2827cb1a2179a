#include "information_form.h"

#include <algorithm>
#include <cmath>

namespace submap_slam::landmark_joining {

InformationForm::InformationForm(const JointProblem& problem)
    : problem_(problem),
      pattern_(problem),
      matrix_(pattern_.upperTriangle()),
      vector_(Eigen::VectorXd::Zero(pattern_.size())),
      cholesky_(matrix_) {}

void InformationForm::clear() {
  std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
  vector_.setZero();
}

namespace {

/** Row and column of a Contribution where its i-th part begins: start pose, end pose, landmarks. */
Eigen::Index partAt(std::size_t i) {
  return i < 2 ? 3 * static_cast<Eigen::Index>(i) : 2 + 2 * static_cast<Eigen::Index>(i);
}

int partSize(std::size_t i) { return i < 2 ? 3 : 2; }

}  // namespace

/** Adds the blocks of one part's columns, from the top to the diagonal.
 * @param below_top how far a block's first row is below the first entry of its columns; the same in all */
template <class BelowTop>
void InformationForm::addColumn(const Contribution& c, const std::vector<int>& rows, std::size_t j,
                                const BelowTop& below_top) {
  vector_.segment(rows[j], partSize(j)) += c.vector.segment(partAt(j), partSize(j));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] < 0 || rows[i] > rows[j]) continue;
    const auto offset = below_top(rows[i]);
    for (int column = 0; column < partSize(j); ++column) {
      double* to = matrix_.valuePtr() + matrix_.outerIndexPtr()[rows[j] + column] + offset;
      const int end = i == j ? column + 1 : partSize(i);  // of the block on the diagonal the upper triangle
      const double* from = &c.matrix(partAt(i), partAt(j) + column);
      for (int row = 0; row < end; ++row) *to++ += *from++;
    }
  }
}

/** The same as add() for each, but one block column after the other, so that it is looked up once where in a
 * column a block is. */
void InformationForm::sum(const std::vector<Contribution>& contributions) {
  struct Part {
    std::size_t submap, part;
  };
  clear();
  std::vector<std::vector<int>> rows;
  std::vector<std::vector<Part>> parts_at(static_cast<std::size_t>(pattern_.size()));  // by first row
  for (std::size_t k = 0; k < contributions.size(); ++k) {
    rows.push_back(pattern_.rowsOf(problem_, k));
    for (std::size_t i = 0; i < rows[k].size(); ++i)
      if (rows[k][i] >= 0) parts_at[static_cast<std::size_t>(rows[k][i])].push_back({k, i});
  }
  std::vector<int> below_top(parts_at.size());
  const int *start = matrix_.outerIndexPtr(), *index = matrix_.innerIndexPtr();
  for (int column = 0; column < pattern_.size(); ++column) {
    const auto& parts = parts_at[static_cast<std::size_t>(column)];
    if (parts.empty()) continue;
    for (int e = start[column]; e < start[column + 1]; ++e)
      below_top[static_cast<std::size_t>(index[e])] = e - start[column];
    for (const Part& p : parts)
      addColumn(contributions[p.submap], rows[p.submap], p.part,
                [&](int row) { return below_top[static_cast<std::size_t>(row)]; });
  }
}

void InformationForm::add(std::size_t k, const Contribution& contribution) {
  const std::vector<int> rows = pattern_.rowsOf(problem_, k);
  const int *start = matrix_.outerIndexPtr(), *index = matrix_.innerIndexPtr();
  for (std::size_t j = 0; j < rows.size(); ++j) {
    if (rows[j] < 0) continue;
    const int *top = index + start[rows[j]], *diagonal = index + start[rows[j] + 1] - 1;
    addColumn(contribution, rows, j, [&](int row) { return std::lower_bound(top, diagonal, row) - top; });
  }
}

double InformationForm::lineariseAll(const JointState& state) {
  clear();
  double cost = 0;
  for (std::size_t k = 0; k < problem_.submaps(); ++k) {
    const Contribution contribution = linearise(problem_, state, k);
    add(k, contribution);
    cost += contribution.cost;
  }
  return cost;
}

JointState InformationForm::moved(const JointState& state, const Eigen::VectorXd& step, double share) const {
  JointState result = state;
  for (std::size_t k = 0; k < result.ends.size(); ++k)
    result.ends[k] += share * step.segment<3>(pattern_.poseRow(k));
  for (std::size_t m = 0; m < result.landmarks.size(); ++m)
    result.landmarks[m] += share * step.segment<2>(pattern_.landmarkRow(m));
  return result;
}

Change changeBetween(const JointState& a, const JointState& b) {
  Change change;
  for (std::size_t k = 0; k < a.ends.size(); ++k) {
    const Pose d = (a.ends[k] - b.ends[k]).cwiseAbs();
    change.metres = std::max({change.metres, d[0], d[1]});
    change.radians = std::max(change.radians, d[2]);
  }
  for (std::size_t m = 0; m < a.landmarks.size(); ++m)
    change.metres = std::max(change.metres, (a.landmarks[m] - b.landmarks[m]).cwiseAbs().maxCoeff());
  return change;
}

}  // namespace submap_slam::landmark_joining
