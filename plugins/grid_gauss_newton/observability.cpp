#include "observability.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

namespace submap_slam::grid_joining {
namespace {

/** Share of its information that the chain keeps: hardly any, but enough for a regular matrix. */
constexpr double kWeakPrior = 1e-4;

/** A turn counts as open if it moves what lies this far from the frame by more than half a cell: half the
 * path of a submap of default length (10 m), which is its middle if the path is straight. */
constexpr double kLever_m = 5;

constexpr std::size_t kMostInWords = 3;
constexpr double kDegree = M_PI / 180;

}  // namespace

std::vector<OpenDirection> openDirections(const Evaluation& evaluation, double evidence_variance,
                                          const std::vector<Eigen::Matrix3d>& covariances,
                                          double cell_size_m) {
  PoseSystem weak(covariances.size());
  weak.add(evaluation.evidence.system, 1 / evidence_variance);
  weak.add(evaluation.prior, kWeakPrior);
  const auto alone = marginalCovariances(weak, anchorsOf(evaluation.total), dampingDiagonal(weak, 0));
  std::vector<OpenDirection> open;
  if (!alone) return open;
  const double largest = 0.25 * cell_size_m * cell_size_m;
  for (std::size_t i = 0; i < covariances.size(); ++i) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> position((*alone)[i].topLeftCorner<2, 2>());
    if (position.eigenvalues()[1] > largest) {
      const Eigen::Vector2d d = position.eigenvectors().col(1);
      open.push_back(
          {i, false, std::atan(d.y() / d.x()), std::sqrt(d.dot(covariances[i].topLeftCorner<2, 2>() * d))});
    }
    if ((*alone)[i](2, 2) * kLever_m * kLever_m > largest)
      open.push_back({i, true, 0, std::sqrt(covariances[i](2, 2))});
  }
  return open;
}

std::string describeOpen(const std::vector<OpenDirection>& directions, const std::vector<uint32_t>& ids) {
  if (directions.empty()) return {};
  std::vector<OpenDirection> sorted = directions;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const OpenDirection& a, const OpenDirection& b) { return a.sigma > b.sigma; });
  std::string text = "evidence leaves open ";
  for (std::size_t k = 0; k < std::min(kMostInWords, sorted.size()); ++k) {
    const OpenDirection& open = sorted[k];
    std::array<char, 96> words{};
    if (open.heading)
      std::snprintf(words.data(), words.size(), "the heading of submap %u (sigma %.2g deg)", ids[open.submap],
                    open.sigma / kDegree);
    else
      std::snprintf(words.data(), words.size(), "submap %u along %.0f deg (sigma %.2g m)", ids[open.submap],
                    open.direction / kDegree, open.sigma);
    text += (k > 0 ? ", " : "") + std::string(words.data());
  }
  if (sorted.size() > kMostInWords) text += " and " + std::to_string(sorted.size() - kMostInWords) + " more";
  return text;
}

std::string describeGroups(const std::vector<std::size_t>& groups, const std::vector<uint32_t>& ids) {
  std::map<std::size_t, std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < groups.size(); ++i) members[groups[i]].push_back(i);
  if (members.size() < 2) return {};
  std::string text = std::to_string(members.size()) + " groups that nothing links, each joined for itself:";
  for (const auto& [first, all] : members) {
    text += " {";
    for (std::size_t k = 0, last = 0; k < all.size(); k = last + 1) {  // runs of neighbours
      for (last = k; last + 1 < all.size() && all[last + 1] == all[last] + 1;) ++last;
      text += (k > 0 ? ", " : "") + std::to_string(ids[all[k]]);
      if (last > k) text += "-" + std::to_string(ids[all[last]]);
    }
    text += "}";
  }
  return text;
}

}  // namespace submap_slam::grid_joining
