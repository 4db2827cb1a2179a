#include "information_form.h"

#include <algorithm>
#include <cmath>

namespace submap_slam::landmark_joining {

InformationForm::InformationForm(const JointProblem& problem)
    : problem_(problem),
      pattern_(problem),
      matrix_(pattern_.lowerTriangle()),
      vector_(Eigen::VectorXd::Zero(pattern_.size())),
      cholesky_(matrix_) {}

void InformationForm::clear() {
  std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
  vector_.setZero();
}

void InformationForm::add(std::size_t k, const Contribution& c) {
  const std::vector<int> rows = pattern_.rowsOf(problem_, k);
  const auto part = [](std::size_t i) {
    return i < 2 ? 3 * static_cast<int>(i) : 2 + 2 * static_cast<int>(i);
  };
  const int *start = matrix_.outerIndexPtr(), *index = matrix_.innerIndexPtr();
  for (std::size_t j = 0; j < rows.size(); ++j) {
    if (rows[j] < 0) continue;
    const int width = j < 2 ? 3 : 2;
    vector_.segment(rows[j], width) += c.vector.segment(part(j), width);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i] < rows[j]) continue;
      const int height = i < 2 ? 3 : 2;
      for (int column = 0; column < width; ++column) {
        const int first = i == j ? column : 0;  // of the block on the diagonal only the lower triangle
        const int to_column = rows[j] + column;
        const int* found =
            std::lower_bound(index + start[to_column], index + start[to_column + 1], rows[i] + first);
        double* to = matrix_.valuePtr() + (found - index);
        for (int row = first; row < height; ++row) *to++ += c.matrix(part(i) + row, part(j) + column);
      }
    }
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
