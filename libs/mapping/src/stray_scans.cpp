#include <submap_slam/mapping/stray_scans.h>

namespace submap_slam {
namespace {

/** Shares of inlier beams. */
constexpr double kFitsNothingBelow = 0.25, kFitsWellFrom = 0.5;
/** Scans that it takes to know how well they fit. */
constexpr std::size_t kFewest = 5;

}  // namespace

bool fitsNothing(const LocalPath& path, std::size_t k) {
  return k >= kFewest && static_cast<double>(path[k].inlier_share) < kFitsNothingBelow &&
         usualInlierShare(path, k) >= kFitsWellFrom;
}

std::size_t scansThatFitNothing(const LocalPath& path, std::size_t k) {
  std::size_t count = 0;
  while (count <= k && fitsNothing(path, k - count)) ++count;
  return count;
}

}  // namespace submap_slam
