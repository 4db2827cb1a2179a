#include "compatibility.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace submap_slam::landmark_joining {
namespace {

/** A set of pairings that grows and shrinks at its end, with its joint distance: the Cholesky factor of its
 * covariance gets two rows with each pairing. */
class JointSet {
 public:
  explicit JointSet(const Candidates& candidates)
      : all_(candidates),
        factor_(Eigen::MatrixXd::Zero(candidates.covariance.rows(), candidates.covariance.cols())),
        whitened_(Eigen::VectorXd::Zero(candidates.innovation.size())) {}

  /** Adds a pairing if the set agrees with it; false: it does not, nothing is changed. */
  bool push(std::size_t pairing) {
    const auto n = 2 * static_cast<Eigen::Index>(chosen_.size()),
               row = 2 * static_cast<Eigen::Index>(pairing);
    for (Eigen::Index r = 0; r < 2; ++r) {
      const Eigen::Index to = n + r;
      for (Eigen::Index c = 0; c <= to; ++c) {
        const double s = all_.covariance(row + r, rowOf(c, n, row));
        const double rest = s - factor_.row(to).head(c).dot(factor_.row(c).head(c));
        factor_(to, c) = c < to ? rest / factor_(c, c) : std::sqrt(std::max(rest, 1e-300));
      }
      whitened_[to] =
          (all_.innovation[row + r] - factor_.row(to).head(to).dot(whitened_.head(to))) / factor_(to, to);
    }
    const double distance2 = distance2_.empty() ? 0 : distance2_.back();
    const double grown = distance2 + whitened_.segment<2>(n).squaredNorm();
    if (!(grown <= jointGate(all_.gate2, static_cast<std::size_t>(n) + 2))) return false;
    chosen_.push_back(pairing);
    distance2_.push_back(grown);
    return true;
  }

  void pop() { chosen_.pop_back(), distance2_.pop_back(); }

  const std::vector<std::size_t>& chosen() const { return chosen_; }
  double distance2() const { return distance2_.empty() ? 0 : distance2_.back(); }

 private:
  /** Row of the candidates for a row of the factor; the last two are those of the new pairing. */
  Eigen::Index rowOf(Eigen::Index r, Eigen::Index n, Eigen::Index newest) const {
    return r >= n ? newest + (r - n)
                  : 2 * static_cast<Eigen::Index>(chosen_[static_cast<std::size_t>(r / 2)]) + r % 2;
  }

  const Candidates& all_;
  Eigen::MatrixXd factor_;
  Eigen::VectorXd whitened_;
  std::vector<std::size_t> chosen_;
  std::vector<double> distance2_;
};

std::vector<std::size_t> byDistance(const std::vector<Pairing>& pairings) {
  std::vector<std::size_t> order(pairings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return pairings[a].distance2 < pairings[b].distance2;
  });
  return order;
}

/** Twice the logarithm of how much more likely the pairings are than as many new landmarks. */
double evidenceFor(const Candidates& candidates, const std::vector<std::size_t>& set, double density) {
  if (set.empty()) return 0;
  std::vector<Eigen::Index> rows;
  for (const std::size_t pairing : set)
    for (Eigen::Index axis : {0, 1}) rows.push_back(2 * static_cast<Eigen::Index>(pairing) + axis);
  const Eigen::MatrixXd covariance = candidates.covariance(rows, rows);
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  const Eigen::VectorXd whitened = factor.matrixL().solve(candidates.innovation(rows));
  const double log_det = 2 * factor.matrixLLT().diagonal().array().log().sum();
  return -whitened.squaredNorm() - log_det -
         2 * static_cast<double>(set.size()) * std::log(2 * M_PI * density);
}

class BranchAndBound {
 public:
  explicit BranchAndBound(const Candidates& candidates) : all_(candidates), set_(candidates) {
    std::set<int> features;
    for (const auto& p : all_.pairings) features.insert(p.feature);
    for (const int feature : features) {
      of_feature_.emplace_back();
      for (const std::size_t i : byDistance(all_.pairings))
        if (all_.pairings[i].feature == feature) of_feature_.back().push_back(i);
    }
  }

  std::vector<std::size_t> search() {
    descend(0);
    return best_;
  }

 private:
  void descend(std::size_t feature) {
    if (++steps_ > kMostSteps) return;
    if (isBetter()) best_ = set_.chosen(), best_distance2_ = set_.distance2();
    if (feature == of_feature_.size()) return;
    const std::size_t at_most = set_.chosen().size() + of_feature_.size() - feature;
    if (at_most < best_.size()) return;
    for (const std::size_t pairing : of_feature_[feature]) {
      const int landmark = all_.pairings[pairing].landmark;
      if (taken_.count(landmark) > 0 || !set_.push(pairing)) continue;
      taken_.insert(landmark);
      descend(feature + 1);
      taken_.erase(landmark);
      set_.pop();
    }
    if (at_most - 1 >= best_.size()) descend(feature + 1);
  }

  bool isBetter() const {
    const std::size_t size = set_.chosen().size();
    return size > best_.size() || (size == best_.size() && size > 0 && set_.distance2() < best_distance2_);
  }

  static constexpr int kMostSteps = 20'000;
  const Candidates& all_;
  JointSet set_;
  std::vector<std::vector<std::size_t>> of_feature_;
  std::set<int> taken_;
  std::vector<std::size_t> best_;
  double best_distance2_ = 0;
  int steps_ = 0;
};

}  // namespace

double jointGate(double gate2, std::size_t degrees_of_freedom) {
  const double normal_quantile = 3 * std::cbrt(gate2 / 2) - 8.0 / 3;  // of gate2 as χ² with n = 2
  const auto n = static_cast<double>(degrees_of_freedom);
  return n * std::pow(1 - 2 / (9 * n) + normal_quantile * std::sqrt(2 / (9 * n)), 3);
}

std::vector<std::size_t> nearestNeighbours(const Candidates& candidates) {
  JointSet set(candidates);
  std::set<int> features, landmarks;
  for (const std::size_t i : byDistance(candidates.pairings)) {
    const Pairing& p = candidates.pairings[i];
    if (features.count(p.feature) > 0 || landmarks.count(p.landmark) > 0 || !set.push(i)) continue;
    features.insert(p.feature), landmarks.insert(p.landmark);
  }
  return set.chosen();
}

std::vector<std::size_t> jointCompatibility(const Candidates& candidates) {
  return BranchAndBound(candidates).search();
}

std::vector<std::size_t> jointUnlessNearestExplain(const Candidates& candidates) {
  auto nearest = nearestNeighbours(candidates), joint = jointCompatibility(candidates);
  return 2 * joint.size() >= 3 * nearest.size() ? joint : nearest;
}

std::vector<std::size_t> convincing(const Candidates& candidates, const std::vector<std::size_t>& set,
                                    double density) {
  std::vector<std::size_t> strong;
  for (const std::size_t pairing : set)
    if (evidenceFor(candidates, {pairing}, density) >= 0) strong.push_back(pairing);
  const bool together = evidenceFor(candidates, set, density) >= evidenceFor(candidates, strong, density);
  return together ? set : strong;
}

}  // namespace submap_slam::landmark_joining
