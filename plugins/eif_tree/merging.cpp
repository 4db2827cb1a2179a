#include "merging.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "compatibility.h"
#include "covariances.h"

namespace submap_slam::landmark_joining {
namespace {

struct Twins {
  int keep = 0, drop = 0;
  double distance2 = 0;
};

using Partners = std::vector<std::vector<int>>;  ///< of each landmark, of a higher index

std::vector<std::vector<std::size_t>> submapsOfLandmarks(const JointProblem& problem) {
  std::vector<std::vector<std::size_t>> submaps(problem.landmark_count);
  for (std::size_t k = 0; k < problem.submaps(); ++k)
    for (const int m : problem.landmarks[k]) submaps[static_cast<std::size_t>(m)].push_back(k);
  return submaps;
}

bool haveOneInCommon(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
  for (auto i = a.begin(), k = b.begin(); i != a.end() && k != b.end(); *i < *k ? ++i : ++k)
    if (*i == *k) return true;
  return false;
}

/** Pairs that may agree as far as their marginal covariances tell (that of the difference of two landmarks is
 * at most twice the sum of theirs), and that no submap holds both of. */
Partners possibleTwins(const JointProblem& problem, const JointState& state, const Covariances& covariances,
                       double gate2) {
  const auto submaps = submapsOfLandmarks(problem);
  Partners partners(problem.landmark_count);
  for (std::size_t a = 0; a < state.landmarks.size(); ++a)
    for (std::size_t b = a + 1; b < state.landmarks.size(); ++b) {
      const double spread = covariances.landmarks[a].trace() + covariances.landmarks[b].trace();
      if ((state.landmarks[a] - state.landmarks[b]).squaredNorm() <= 2 * gate2 * spread &&
          !haveOneInCommon(submaps[a], submaps[b]))
        partners[a].push_back(static_cast<int>(b));
    }
  return partners;
}

/** Half inverses of the landmarks that are in a pair; empty for the others. */
std::vector<HalfInverse> halfInverses(const InformationForm& form, const Partners& partners) {
  std::vector<bool> needed(partners.size());
  for (std::size_t a = 0; a < partners.size(); ++a)
    for (const int b : partners[a]) needed[a] = needed[static_cast<std::size_t>(b)] = true;
  std::vector<HalfInverse> halves(partners.size());
  for (std::size_t m = 0; m < partners.size(); ++m) {
    const int row = form.pattern().landmarkRow(m);
    if (needed[m]) halves[m] = form.cholesky().halfInverse({row, row + 1});
  }
  return halves;
}

/** Features in a square metre of all submaps together. */
double densityOf(const JointProblem& problem) {
  double features = 0, area = 0;
  for (const Observation* observation : problem.observations) {
    const Eigen::VectorXd z = observation->z.tail(observation->z.size() - 3);
    features += static_cast<double>(z.size()) / 2;
    area += areaOf(z);
  }
  return features / area;
}

/** Pairs within the gate, and more likely than two landmarks, in the order of their distance; each landmark
 * in one of them. */
std::vector<Twins> findTwins(const JointProblem& problem, const JointState& state, double gate2) {
  InformationForm form(problem);
  form.lineariseAll(state);
  std::vector<Twins> twins;
  if (!form.factorize()) return twins;
  const Covariances covariances = marginalCovariances(problem, form);
  const Partners partners = possibleTwins(problem, state, covariances, gate2);
  const auto halves = halfInverses(form, partners);
  const double evidence_of_two = 2 * std::log(2 * M_PI * densityOf(problem));
  for (std::size_t a = 0; a < partners.size(); ++a)
    for (const int partner : partners[a]) {
      const auto b = static_cast<std::size_t>(partner);
      const Eigen::Matrix2d cross = inverseBetween(halves[a], halves[b]);
      const Eigen::Matrix2d s =
          covariances.landmarks[a] + covariances.landmarks[b] - cross - cross.transpose();
      const Point d = state.landmarks[a] - state.landmarks[b];
      const double distance2 = d.dot(s.inverse() * d);
      const double evidence_of_one = -distance2 - std::log(s.determinant());
      if (distance2 <= gate2 && evidence_of_one >= evidence_of_two)
        twins.push_back({static_cast<int>(a), partner, distance2});
    }
  std::stable_sort(twins.begin(), twins.end(),
                   [](const Twins& a, const Twins& b) { return a.distance2 < b.distance2; });
  std::set<int> used;
  const auto again = [&used](const Twins& t) {
    if (used.count(t.keep) > 0 || used.count(t.drop) > 0) return true;
    used.insert({t.keep, t.drop});
    return false;
  };
  twins.erase(std::remove_if(twins.begin(), twins.end(), again), twins.end());
  return twins;
}

/** New index of each landmark when the dropped ones are gone. */
std::vector<int> renumbered(std::size_t count, const std::vector<Twins>& twins) {
  std::vector<int> target(count, -1), index(count);
  for (const Twins& t : twins) target[static_cast<std::size_t>(t.drop)] = t.keep;
  int next = 0;
  for (std::size_t m = 0; m < count; ++m) index[m] = target[m] < 0 ? next++ : -1;
  for (std::size_t m = 0; m < count; ++m)
    if (target[m] >= 0) index[m] = index[static_cast<std::size_t>(target[m])];
  return index;
}

struct Merged {
  JointProblem problem;
  JointState state;
  double objective = 0;
};

std::optional<Merged> tryMerge(const JointProblem& problem, const JointState& state,
                               const std::vector<int>& index, const GaussNewtonOptions& gauss_newton) {
  Merged merged;
  merged.problem.observations = problem.observations;
  merged.state.ends = state.ends;
  for (std::size_t m = 0; m < index.size(); ++m)
    if (index[m] == static_cast<int>(merged.state.landmarks.size()))
      merged.state.landmarks.push_back(state.landmarks[m]);
  merged.problem.landmark_count = merged.state.landmarks.size();
  for (const auto& landmarks : problem.landmarks) {
    merged.problem.landmarks.emplace_back();
    for (const int m : landmarks)
      merged.problem.landmarks.back().push_back(index[static_cast<std::size_t>(m)]);
    auto sorted = merged.problem.landmarks.back();
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return std::nullopt;
  }
  InformationForm form(merged.problem);
  const auto result = minimise(merged.problem, form, merged.state, gauss_newton, {});
  if (result.status == JoinStatus::kFailed) return std::nullopt;
  merged.objective = result.objective;
  return merged;
}

void apply(Merged merged, const std::vector<int>& index, AssociatedProblem& associated, JointState& state) {
  std::vector<uint32_t> hits(merged.problem.landmark_count), ids(merged.problem.landmark_count);
  std::vector<bool> named(merged.problem.landmark_count);
  std::map<uint32_t, uint32_t> id_of;
  for (std::size_t m = 0; m < index.size(); ++m) {
    const auto to = static_cast<std::size_t>(index[m]);
    if (!named[to]) ids[to] = associated.landmark_ids[m], named[to] = true;
    hits[to] += associated.hits[m];
    id_of[associated.landmark_ids[m]] = ids[to];
  }
  for (auto& a : associated.associations)
    if (a.kind != FeatureAssociation::Kind::kDropped) a.landmark = id_of.at(a.landmark);
  associated.landmark_ids = std::move(ids);
  associated.hits = std::move(hits);
  associated.problem = std::move(merged.problem);
  state = std::move(merged.state);
}

}  // namespace

std::size_t mergeDuplicates(AssociatedProblem& associated, JointState& state, double gate2,
                            const GaussNewtonOptions& gauss_newton) {
  std::size_t merges = 0;
  for (auto twins = findTwins(associated.problem, state, gate2); !twins.empty();) {
    const std::vector<int> index = renumbered(associated.problem.landmark_count, twins);
    auto merged = tryMerge(associated.problem, state, index, gauss_newton);
    const double before = objective(associated.problem, state);
    if (merged && merged->objective - before <= jointGate(gate2, 2 * twins.size())) {
      merges += twins.size();
      apply(std::move(*merged), index, associated, state);
      twins = findTwins(associated.problem, state, gate2);
    } else {
      twins.resize(twins.size() / 2);
    }
  }
  return merges;
}

}  // namespace submap_slam::landmark_joining
