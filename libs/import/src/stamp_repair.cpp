#include "stamp_repair.h"

#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

constexpr double kDefaultStep_s = 0.1;

/** Indices of the longest increasing subsequence, by patience sorting in O(n log n). */
std::vector<std::size_t> longestIncreasing(const std::vector<double>& values) {
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> ends;  // ends[k]: last index of the best subsequence of length k + 1
  std::vector<std::size_t> before(values.size(), kNone);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto place = std::lower_bound(ends.begin(), ends.end(), values[i],
                                        [&](std::size_t end, double v) { return values[end] < v; });
    if (place != ends.begin()) before[i] = *(place - 1);
    if (place == ends.end())
      ends.push_back(i);
    else
      *place = i;
  }
  std::vector<std::size_t> kept;
  for (std::size_t i = ends.empty() ? kNone : ends.back(); i != kNone; i = before[i]) kept.push_back(i);
  std::reverse(kept.begin(), kept.end());
  return kept;
}

double medianStep(const std::vector<double>& values, const std::vector<std::size_t>& kept) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < kept.size(); ++k)
    steps.push_back((values[kept[k]] - values[kept[k - 1]]) / static_cast<double>(kept[k] - kept[k - 1]));
  if (steps.empty()) return kDefaultStep_s;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

}  // namespace

RepairedStamps repairStamps(const std::vector<double>& stamps_s) {
  RepairedStamps result{stamps_s, 0, 0};
  const auto kept = longestIncreasing(stamps_s);
  if (kept.empty()) return result;
  const double step = medianStep(stamps_s, kept);
  std::size_t next = 0;  // position in `kept` of the first one at or behind i
  for (std::size_t i = 0; i < stamps_s.size(); ++i) {
    if (next < kept.size() && kept[next] == i) {
      ++next;
      continue;
    }
    double& stamp = result.stamps_s[i];
    if (next == 0) {
      stamp = stamps_s[kept[0]] - step * static_cast<double>(kept[0] - i);
    } else if (next == kept.size()) {
      stamp = stamps_s[kept.back()] + step * static_cast<double>(i - kept.back());
    } else {
      const std::size_t a = kept[next - 1], b = kept[next];
      stamp =
          stamps_s[a] + (stamps_s[b] - stamps_s[a]) * static_cast<double>(i - a) / static_cast<double>(b - a);
    }
    ++result.replaced;
    result.largest_shift_s = std::max(result.largest_shift_s, std::abs(stamp - stamps_s[i]));
  }
  return result;
}

}  // namespace submap_slam
