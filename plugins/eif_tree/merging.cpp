#include "merging.h"

#include <Eigen/LU>
#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "compatibility.h"
#include "covariances.h"

namespace submap_slam::landmark_joining {
namespace {

struct Twins {
  int keep = 0, drop = 0;
  double distance2 = 0;
};

/** Pairs of landmarks that one submap holds both of. */
std::set<std::pair<int, int>> seenTogether(const JointProblem& problem,
                                           const std::vector<std::pair<int, int>>& near) {
  std::vector<std::vector<std::size_t>> submaps_of(problem.landmark_count);
  for (std::size_t k = 0; k < problem.submaps(); ++k)
    for (const int m : problem.landmarks[k]) submaps_of[static_cast<std::size_t>(m)].push_back(k);
  std::set<std::pair<int, int>> together;
  for (const auto& [a, b] : near) {
    const auto &in_a = submaps_of[static_cast<std::size_t>(a)],
               &in_b = submaps_of[static_cast<std::size_t>(b)];
    std::vector<std::size_t> both;
    std::set_intersection(in_a.begin(), in_a.end(), in_b.begin(), in_b.end(), std::back_inserter(both));
    if (!both.empty()) together.emplace(a, b);
  }
  return together;
}

/** Pairs that may agree as far as their marginal covariances tell: that of the difference of two landmarks is
 * at most twice the sum of theirs. */
std::vector<std::pair<int, int>> nearPairs(const JointState& state, const Covariances& covariances,
                                           double gate2) {
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t a = 0; a < state.landmarks.size(); ++a)
    for (std::size_t b = a + 1; b < state.landmarks.size(); ++b) {
      const double spread = covariances.landmarks[a].trace() + covariances.landmarks[b].trace();
      if ((state.landmarks[a] - state.landmarks[b]).squaredNorm() <= 2 * gate2 * spread)
        pairs.emplace_back(static_cast<int>(a), static_cast<int>(b));
    }
  return pairs;
}

double distance2Between(InformationForm& form, const JointState& state, int a, int b) {
  const int row_a = form.pattern().landmarkRow(static_cast<std::size_t>(a)),
            row_b = form.pattern().landmarkRow(static_cast<std::size_t>(b));
  const Eigen::Matrix4d c = covarianceOf(form, {row_a, row_a + 1, row_b, row_b + 1});
  const Eigen::Matrix2d s = c.topLeftCorner<2, 2>() + c.bottomRightCorner<2, 2>() - c.topRightCorner<2, 2>() -
                            c.bottomLeftCorner<2, 2>();
  const Point d = state.landmarks[static_cast<std::size_t>(a)] - state.landmarks[static_cast<std::size_t>(b)];
  return d.dot(s.inverse() * d);
}

/** Pairs within the gate in the order of their distance, each landmark in one of them. */
std::vector<Twins> findTwins(const JointProblem& problem, const JointState& state, double gate2) {
  InformationForm form(problem);
  form.lineariseAll(state);
  std::vector<Twins> twins;
  if (!form.factorize()) return twins;
  const auto near = nearPairs(state, marginalCovariances(problem, form), gate2);
  const auto together = seenTogether(problem, near);
  for (const auto& pair : near) {
    if (together.count(pair) > 0) continue;
    const double distance2 = distance2Between(form, state, pair.first, pair.second);
    if (distance2 <= gate2) twins.push_back({pair.first, pair.second, distance2});
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
