#include "chaining.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace submap_slam::landmark_joining {
namespace {

/** A C Aᵀ + B Q Bᵀ with the Jacobians of start ∘ z by the start pose and by the pose z.
 * @param to position of start ∘ z */
Eigen::Matrix3d composedCovariance(const Pose& start, const Eigen::Matrix3d& c_start, const Point& to,
                                   const Eigen::Matrix3d& q) {
  const double c = std::cos(start[2]), s = std::sin(start[2]);
  Eigen::Matrix3d a, b;
  a << 1, 0, start.y() - to.y(), 0, 1, to.x() - start.x(), 0, 0, 1;
  b << c, -s, 0, s, c, 0, 0, 0, 1;
  return a * c_start * a.transpose() + b * q * b.transpose();
}

void append(const JointProblem& problem, std::size_t k, std::vector<bool>& seen, Estimate& estimate) {
  auto& [state, covariances] = estimate;
  const Observation& observation = *problem.observations[k];
  const Eigen::Index n = observation.z.size();
  const Eigen::MatrixXd q = observation.information.llt().solve(Eigen::MatrixXd::Identity(n, n));
  const Pose start = startOf(state, k);
  const Eigen::Matrix3d c_start = k == 0 ? Eigen::Matrix3d(Eigen::Matrix3d::Zero()) : covariances.ends[k - 1];
  for (std::size_t i = 0; i < problem.landmarks[k].size(); ++i) {
    const auto landmark = static_cast<std::size_t>(problem.landmarks[k][i]);
    if (seen[landmark]) continue;
    seen[landmark] = true;
    const auto row = 3 + 2 * static_cast<Eigen::Index>(i);
    const Point point = compose(start, Point(observation.z.segment<2>(row)));
    Eigen::Matrix3d q_point = Eigen::Matrix3d::Zero();
    q_point.topLeftCorner<2, 2>() = q.block<2, 2>(row, row);
    state.landmarks[landmark] = point;
    covariances.landmarks[landmark] =
        composedCovariance(start, c_start, point, q_point).topLeftCorner<2, 2>();
  }
  const Pose end = compose(start, Pose(observation.z.head<3>()));
  state.ends.push_back(end);
  covariances.ends.push_back(composedCovariance(start, c_start, end.head<2>(), q.topLeftCorner<3, 3>()));
}

}  // namespace

void chainOn(const JointProblem& problem, Estimate& estimate) {
  const std::size_t joined = estimate.state.ends.size();
  estimate.state.landmarks.resize(problem.landmark_count, Point::Zero());
  estimate.covariances.landmarks.resize(problem.landmark_count, Eigen::Matrix2d::Zero());
  std::vector<bool> seen(problem.landmark_count);
  for (std::size_t k = 0; k < joined; ++k)
    for (const int landmark : problem.landmarks[k]) seen[static_cast<std::size_t>(landmark)] = true;
  for (std::size_t k = joined; k < problem.submaps(); ++k) append(problem, k, seen, estimate);
}

Estimate chained(const JointProblem& problem) {
  Estimate estimate;
  chainOn(problem, estimate);
  return estimate;
}

}  // namespace submap_slam::landmark_joining
