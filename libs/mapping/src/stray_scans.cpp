#include <submap_slam/mapping/stray_scans.h>

#include <algorithm>
#include <vector>

namespace submap_slam {
namespace {

/** Shares of inlier beams; the first one is of what is usual. */
constexpr double kFitsNothingBelow = 0.6, kFitsWellFrom = 0.5;
/** Scans that it takes to know how well they fit. */
constexpr std::size_t kFewest = 5;

/** Median of the shares of the scans before k, up to ten of them: a few stray scans don't change it. */
double medianInlierShare(const LocalPath& path, std::size_t k) {
  constexpr std::size_t kScans = 10;
  std::vector<float> shares;
  for (std::size_t i = k - std::min(kScans, k); i < k; ++i) shares.push_back(path[i].inlier_share);
  const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
  std::nth_element(shares.begin(), middle, shares.end());
  return static_cast<double>(*middle);
}

}  // namespace

bool fitsNothing(const LocalPath& path, std::size_t k) {
  if (k < kFewest) return false;
  const double usual = medianInlierShare(path, k);
  return usual >= kFitsWellFrom && static_cast<double>(path[k].inlier_share) < kFitsNothingBelow * usual;
}

std::size_t scansThatFitNothing(const LocalPath& path, std::size_t k) {
  std::size_t count = 0;
  while (count <= k && fitsNothing(path, k - count)) ++count;
  return count;
}

}  // namespace submap_slam
