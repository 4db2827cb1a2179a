#include "dense_filter.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

namespace submap_slam::landmark_joining {
namespace {

/** State (end poses and landmarks in the order in which they came) with its covariance. */
class DenseFilter {
 public:
  explicit DenseFilter(const JointProblem& problem)
      : problem_(problem), landmark_row_(problem.landmark_count, -1) {}

  bool fuse(std::size_t k) {
    const Eigen::Index first_new = x_.size();
    append(k);
    std::vector<std::pair<int, int>> twins;  // rows of a landmark that was known and of its second estimate
    std::vector<int> keep;
    for (Eigen::Index row = 0; row < first_new + 3; ++row) keep.push_back(static_cast<int>(row));
    end_row_.push_back(static_cast<int>(first_new));
    for (std::size_t i = 0; i < problem_.landmarks[k].size(); ++i) {
      int& known = landmark_row_[static_cast<std::size_t>(problem_.landmarks[k][i])];
      const int row = static_cast<int>(first_new) + 3 + 2 * static_cast<int>(i);
      if (known >= 0) {
        twins.emplace_back(known, row);
      } else {
        known = static_cast<int>(keep.size());
        keep.push_back(row), keep.push_back(row + 1);
      }
    }
    if (!constrain(twins)) return false;
    x_ = x_(keep).eval();
    p_ = p_(keep, keep).eval();
    return true;
  }

  Estimate estimate() const {
    Estimate e;
    for (const int row : end_row_) {
      e.state.ends.emplace_back(x_.segment<3>(row));
      e.covariances.ends.emplace_back(p_.block<3, 3>(row, row));
    }
    e.state.landmarks.assign(landmark_row_.size(), Point::Zero());
    e.covariances.landmarks.assign(landmark_row_.size(), Eigen::Matrix2d::Zero());
    for (std::size_t m = 0; m < landmark_row_.size(); ++m) {
      const int row = landmark_row_[m];
      if (row < 0) continue;
      e.state.landmarks[m] = x_.segment<2>(row);
      e.covariances.landmarks[m] = p_.block<2, 2>(row, row);
    }
    return e;
  }

 private:
  void append(std::size_t k);
  bool constrain(const std::vector<std::pair<int, int>>& twins);

  const JointProblem& problem_;
  Eigen::VectorXd x_;
  Eigen::MatrixXd p_;
  std::vector<int> end_row_, landmark_row_;
};

/** Adds the submap's end pose and features, moved to the map: y = start ∘ z, with the Jacobians A of the
 * start pose and B of z. */
void DenseFilter::append(std::size_t k) {
  const Observation& observation = *problem_.observations[k];
  const Eigen::Index old = x_.size(), n = observation.z.size();
  const Pose start = k == 0 ? Pose(Pose::Zero()) : Pose(x_.segment<3>(end_row_[k - 1]));
  Eigen::VectorXd y(n);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, 3), b = Eigen::MatrixXd::Zero(n, n);
  const double c = std::cos(start[2]), s = std::sin(start[2]);
  const auto move = [&](Eigen::Index row) {
    const Point from_start = compose(start, Point(observation.z.segment<2>(row))) - start.head<2>();
    y.segment<2>(row) = start.head<2>() + from_start;
    a.block<2, 3>(row, 0) << 1, 0, -from_start.y(), 0, 1, from_start.x();
    b.block<2, 2>(row, row) << c, -s, s, c;
  };
  move(0);
  y[2] = start[2] + observation.z[2];
  a(2, 2) = b(2, 2) = 1;
  for (Eigen::Index row = 3; row < n; row += 2) move(row);

  const Eigen::MatrixXd q = observation.information.llt().solve(Eigen::MatrixXd::Identity(n, n));
  x_.conservativeResize(old + n);
  x_.tail(n) = y;
  p_.conservativeResize(old + n, old + n);
  p_.bottomRightCorner(n, n) = b * q * b.transpose();
  if (k == 0) return;
  const int pose = end_row_[k - 1];
  p_.bottomLeftCorner(n, old) = a * p_.block(pose, 0, 3, old);
  p_.topRightCorner(old, n) = p_.bottomLeftCorner(n, old).transpose();
  p_.bottomRightCorner(n, n) += a * p_.block<3, 3>(pose, pose) * a.transpose();
}

/** Kalman update with 0 = x_known − x_twin, without noise. */
bool DenseFilter::constrain(const std::vector<std::pair<int, int>>& twins) {
  if (twins.empty()) return true;
  const auto count = 2 * static_cast<Eigen::Index>(twins.size());
  Eigen::MatrixXd hp(count, p_.cols());
  Eigen::VectorXd innovation(count);
  for (std::size_t i = 0; i < twins.size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    hp.middleRows<2>(row) = p_.middleRows<2>(twins[i].first) - p_.middleRows<2>(twins[i].second);
    innovation.segment<2>(row) = x_.segment<2>(twins[i].second) - x_.segment<2>(twins[i].first);
  }
  Eigen::MatrixXd s(count, count);
  for (std::size_t i = 0; i < twins.size(); ++i)
    s.middleCols<2>(2 * static_cast<Eigen::Index>(i)) =
        hp.middleCols<2>(twins[i].first) - hp.middleCols<2>(twins[i].second);
  const Eigen::LLT<Eigen::MatrixXd> factor(s);
  if (factor.info() != Eigen::Success) return false;
  const Eigen::MatrixXd gain = factor.solve(hp).transpose();
  x_ += gain * innovation;
  p_ -= gain * hp;
  p_ = (0.5 * (p_ + p_.transpose())).eval();
  return true;
}

}  // namespace

std::size_t stateSize(const JointProblem& problem) {
  return 3 * problem.submaps() + 2 * problem.landmark_count;
}

std::optional<Estimate> joinDense(const JointProblem& problem, const std::function<bool(double)>& progress) {
  const std::size_t submaps = problem.submaps();
  DenseFilter filter(problem);
  for (std::size_t k = 0; k < submaps; ++k) {
    if (!filter.fuse(k)) return std::nullopt;
    // Work grows with the square of the state.
    const double share = static_cast<double>(k + 1) / static_cast<double>(submaps);
    if (progress && !progress(share * share * share)) break;
  }
  return filter.estimate();
}

}  // namespace submap_slam::landmark_joining
