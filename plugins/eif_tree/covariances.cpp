#include "covariances.h"

namespace submap_slam::landmark_joining {
namespace {

template <int Size>
Eigen::Matrix<double, Size, Size> blockAt(const SelectedInverse& inverse, int row) {
  Eigen::Matrix<double, Size, Size> block;
  for (int c = 0; c < Size; ++c)
    for (int r = 0; r < Size; ++r) block(r, c) = inverse.at(row + r, row + c);
  return block;
}

}  // namespace

Covariances marginalCovariances(const JointProblem& problem, const InformationForm& form) {
  const SelectedInverse inverse(form.cholesky().factor());
  Covariances covariances;
  for (std::size_t k = 0; k < problem.submaps(); ++k)
    covariances.ends.push_back(blockAt<3>(inverse, form.pattern().poseRow(k)));
  for (std::size_t m = 0; m < problem.landmark_count; ++m)
    covariances.landmarks.push_back(blockAt<2>(inverse, form.pattern().landmarkRow(m)));
  return covariances;
}

Eigen::MatrixXd covarianceOf(const InformationForm& form, const std::vector<int>& rows) {
  const auto half = form.cholesky().halfInverse(rows).values;
  return half.transpose() * half;
}

}  // namespace submap_slam::landmark_joining
