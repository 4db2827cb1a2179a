#include <submap_slam/core/doubtful_ends.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace submap_slam {
namespace {

constexpr double kDoubtful_m = 0.1, kDoubtful_rad = 0.05;
constexpr std::size_t kMostInWords = 5;

/** Disjoint sets; each is named by its first member. */
class Groups {
 public:
  explicit Groups(std::size_t members) : parents_(members) {
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
  }

  std::size_t of(std::size_t member) const {
    while (parents_[member] != member) member = parents_[member];
    return member;
  }

  void link(std::size_t a, std::size_t b) {
    const auto [first, second] = std::minmax({of(a), of(b)});
    parents_[second] = first;
  }

 private:
  std::vector<std::size_t> parents_;
};

}  // namespace

bool endIsDoubtful(const GridSubmap& submap) {
  const auto& cov = submap.end_pose.cov;
  return !submap.has_successor || std::sqrt(std::max(cov(0, 0), cov(1, 1))) >= kDoubtful_m ||
         std::sqrt(cov(2, 2)) >= kDoubtful_rad;
}

std::vector<std::size_t> breaksOf(const GridSubmaps& submaps, const std::vector<Constraint>& constraints) {
  std::map<uint32_t, std::size_t> position_of;
  for (std::size_t k = 0; k < submaps.size(); ++k) position_of.emplace(submaps[k]->id, k);
  Groups groups(submaps.size());
  for (std::size_t k = 0; k + 1 < submaps.size(); ++k)
    if (!endIsDoubtful(*submaps[k])) groups.link(k, k + 1);
  for (const Constraint& constraint : constraints) {
    const auto from = position_of.find(constraint.from), to = position_of.find(constraint.to);
    if (!constraint.accepted || !(constraint.inter || constraint.by_hand)) continue;
    if (from != position_of.end() && to != position_of.end()) groups.link(from->second, to->second);
  }
  std::vector<std::size_t> breaks;
  for (std::size_t k = 1; k < submaps.size(); ++k)
    if (groups.of(k) == k) breaks.push_back(k);
  return breaks;
}

std::string describeBreaks(const GridSubmaps& submaps, const std::vector<Constraint>& constraints) {
  const auto breaks = breaksOf(submaps, constraints);
  if (breaks.empty()) return {};
  std::vector<uint32_t> ids;
  ids.reserve(breaks.size());
  for (const std::size_t k : breaks) ids.push_back(submaps[k]->id);
  const std::size_t shown = std::min(ids.size(), kMostInWords);
  const auto more = ids.size() > shown ? fmt::format(" and {} more", ids.size() - shown) : std::string();
  return fmt::format(
      "the log has a break before submap {}{}: scans and odometry contradict each other there and nothing "
      "else links "
      "what is before to what is behind; where they lie to each other may be wrong",
      fmt::join(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(shown), ", "), more);
}

}  // namespace submap_slam
