#include "compatibility.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>

namespace submap_slam::landmark_joining {
namespace {

std::size_t countFeatures(const Candidates& candidates) {
  std::set<int> features;
  for (const Pairing& p : candidates.pairings) features.insert(p.feature);
  return features.size();
}

/** A set of pairings, each feature once, that grows and shrinks at its end, with its joint distance: the
 * Cholesky factor of its covariance gets two rows with each pairing. */
class JointSet {
 public:
  explicit JointSet(const Candidates& candidates) : all_(candidates) {
    const auto rows = 2 * static_cast<Eigen::Index>(countFeatures(candidates));
    factor_.setZero(rows, rows);
    whitened_.setZero(rows);
  }

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
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> factor_;
  Eigen::VectorXd whitened_;
  std::vector<std::size_t> chosen_;
  std::vector<double> distance2_;
};

/** Indices in the order of their distances. */
std::vector<std::size_t> ascending(const std::vector<double>& distances2) {
  std::vector<std::size_t> order(distances2.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return distances2[a] < distances2[b]; });
  return order;
}

std::vector<std::size_t> byDistance(const std::vector<Pairing>& pairings) {
  std::vector<double> distances2;
  distances2.reserve(pairings.size());
  for (const Pairing& p : pairings) distances2.push_back(p.distance2);
  return ascending(distances2);
}

/** Pairings in the order of their distance from where one of them puts them. */
std::vector<std::size_t> byDistanceGiven(const Candidates& all, std::size_t pairing) {
  const auto at = 2 * static_cast<Eigen::Index>(pairing);
  const Eigen::MatrixX2d gain =
      all.covariance.middleCols<2>(at) * all.covariance.block<2, 2>(at, at).inverse();
  const Eigen::VectorXd innovation = all.innovation - gain * all.innovation.segment<2>(at);
  std::vector<double> distances2;
  for (Eigen::Index row = 0; row < innovation.size(); row += 2) {
    const Eigen::Matrix2d s =
        all.covariance.block<2, 2>(row, row) - gain.middleRows<2>(row) * all.covariance.block<2, 2>(at, row);
    const Eigen::Vector2d v = innovation.segment<2>(row);
    const double distance2 = row == at ? 0 : v.dot(s.inverse() * v);
    distances2.push_back(std::isfinite(distance2) ? distance2 : std::numeric_limits<double>::infinity());
  }
  return ascending(distances2);
}

/** Takes pairings in an order, each feature and each landmark once, that agree with those before. */
std::vector<std::size_t> greedy(const Candidates& candidates, const std::vector<std::size_t>& order) {
  JointSet set(candidates);
  std::set<int> features, landmarks;
  for (const std::size_t i : order) {
    const Pairing& p = candidates.pairings[i];
    if (features.count(p.feature) > 0 || landmarks.count(p.landmark) > 0 || !set.push(i)) continue;
    features.insert(p.feature), landmarks.insert(p.landmark);
  }
  return set.chosen();
}

/** Twice the logarithm of the joint density of the pairings' innovations, without the powers of 2π. */
double logDensity(const Candidates& candidates, const std::vector<std::size_t>& set) {
  if (set.empty()) return 0;
  std::vector<Eigen::Index> rows;
  for (const std::size_t pairing : set)
    for (Eigen::Index axis : {0, 1}) rows.push_back(2 * static_cast<Eigen::Index>(pairing) + axis);
  const Eigen::MatrixXd covariance = candidates.covariance(rows, rows);
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  const Eigen::VectorXd whitened = factor.matrixL().solve(candidates.innovation(rows));
  const double log_det = 2 * factor.matrixLLT().diagonal().array().log().sum();
  return -whitened.squaredNorm() - log_det;
}

/** Twice the logarithm of how much more likely the pairings are than as many new landmarks. */
double evidenceFor(const Candidates& candidates, const std::vector<std::size_t>& set, double density) {
  return logDensity(candidates, set) - 2 * static_cast<double>(set.size()) * std::log(2 * M_PI * density);
}

/** The pairings of a set that are not in another one. */
std::vector<std::size_t> difference(std::vector<std::size_t> set, std::vector<std::size_t> other) {
  std::vector<std::size_t> rest;
  std::sort(set.begin(), set.end()), std::sort(other.begin(), other.end());
  std::set_difference(set.begin(), set.end(), other.begin(), other.end(), std::back_inserter(rest));
  return rest;
}

/** The pairings of a set whose features another one pairs too. */
std::vector<std::size_t> ofFeatures(const Candidates& candidates, const std::vector<std::size_t>& set,
                                    const std::vector<std::size_t>& other) {
  std::set<int> features;
  for (const std::size_t i : other) features.insert(candidates.pairings[i].feature);
  std::vector<std::size_t> common;
  for (const std::size_t i : set)
    if (features.count(candidates.pairings[i].feature) > 0) common.push_back(i);
  return common;
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

/** True if two pairings of a feature cannot both be right: their landmarks are not one. */
bool areApart(const Candidates& candidates, std::size_t a, std::size_t b) {
  const auto i = 2 * static_cast<Eigen::Index>(a), k = 2 * static_cast<Eigen::Index>(b);
  const auto covariance = [&](Eigen::Index row, Eigen::Index column) {
    return Eigen::Matrix2d(candidates.covariance.block<2, 2>(row, column));
  };
  const Eigen::Matrix2d s = covariance(i, i) + covariance(k, k) - covariance(i, k) - covariance(k, i);
  const Eigen::Vector2d d = candidates.innovation.segment<2>(i) - candidates.innovation.segment<2>(k);
  return d.dot(s.inverse() * d) > candidates.gate2;
}

/** How many pairings have a counterpart in another set that takes their feature for another landmark. */
std::size_t countElsewhere(const Candidates& candidates, const std::vector<std::size_t>& set,
                           const std::vector<std::size_t>& other) {
  return static_cast<std::size_t>(std::count_if(set.begin(), set.end(), [&](std::size_t i) {
    return std::any_of(other.begin(), other.end(), [&](std::size_t k) {
      return candidates.pairings[i].feature == candidates.pairings[k].feature && areApart(candidates, i, k);
    });
  }));
}

}  // namespace

double jointGate(double gate2, std::size_t degrees_of_freedom) {
  const double normal_quantile = 3 * std::cbrt(gate2 / 2) - 8.0 / 3;  // of gate2 as χ² with n = 2
  const auto n = static_cast<double>(degrees_of_freedom);
  return n * std::pow(1 - 2 / (9 * n) + normal_quantile * std::sqrt(2 / (9 * n)), 3);
}

std::vector<std::size_t> nearestNeighbours(const Candidates& candidates) {
  return greedy(candidates, byDistance(candidates.pairings));
}

std::vector<std::size_t> jointCompatibility(const Candidates& candidates) {
  return BranchAndBound(candidates).search();
}

std::vector<std::size_t> jointUnlessNearestExplain(const Candidates& candidates) {
  auto nearest = nearestNeighbours(candidates);
  const auto largerByHalf = [&](std::size_t size) { return 2 * size >= 3 * nearest.size(); };
  if (!largerByHalf(countFeatures(candidates))) return nearest;
  auto joint = jointCompatibility(candidates);
  return largerByHalf(joint.size()) ? joint : nearest;
}

std::vector<std::size_t> convincing(const Candidates& candidates, const std::vector<std::size_t>& set,
                                    double density) {
  std::vector<std::size_t> strong;
  for (const std::size_t pairing : set)
    if (evidenceFor(candidates, {pairing}, density) >= 0) strong.push_back(pairing);
  const bool together = evidenceFor(candidates, set, density) >= evidenceFor(candidates, strong, density);
  return together ? set : strong;
}

std::vector<std::size_t> undisputed(const Candidates& candidates, const std::vector<std::size_t>& set) {
  std::vector<std::size_t> left = set;
  std::sort(left.begin(), left.end());
  std::vector<bool> met(candidates.pairings.size());
  for (const std::size_t i : set) met[i] = true;
  for (std::size_t seed = 0; seed < met.size(); ++seed) {
    if (met[seed]) continue;
    const auto rival = greedy(candidates, byDistanceGiven(candidates, seed));
    for (const std::size_t i : rival) met[i] = true;
    const auto disputed = difference(set, rival);
    if (disputed.size() < 2) continue;
    if (3 * countElsewhere(candidates, disputed, difference(rival, set)) < 2 * disputed.size()) continue;
    const double evidence = logDensity(candidates, ofFeatures(candidates, set, rival)) -
                            logDensity(candidates, ofFeatures(candidates, rival, set));
    if (evidence < candidates.gate2) left = difference(left, disputed);
  }
  return left;
}

}  // namespace submap_slam::landmark_joining
