#include "doubtful_steps.h"

#include <mrpt/math/wrap2pi.h>
#include <mrpt/poses/CPose2D.h>
#include <submap_slam/mapping/stray_scans.h>

#include <algorithm>
#include <cmath>

#include "odometry_increment.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** A leap is this many times as long as all but a tenth of the steps, and at least so long. */
constexpr double kLeap = 2.5, kLeast_m = 0.3, kLeast_rad = 0.3;

/** What a step may be off by that scans do not bear out: only odometry says something of it (m, rad). */
constexpr double kAnywhere_m = 5, kAnywhere_rad = 1;

double distanceOf(const TPose2D& step) { return std::hypot(step.x, step.y); }
double turnOf(const TPose2D& step) { return std::abs(mrpt::math::wrapToPi(step.phi)); }

/** All but a tenth of the values are at most that. */
double mostAreWithin(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(9 * values.size() / 10);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

DoubtfulSteps::DoubtfulSteps(const ClosingParams& limits, const std::vector<Frame>& frames)
    : limits_(limits), frames_(frames) {
  std::vector<double> distances, turns;
  for (std::size_t i = 1; i < frames.size(); ++i)
    if (const auto step = incrementBetween(frames[i - 1], frames[i])) {
      distances.push_back(distanceOf(*step));
      turns.push_back(turnOf(*step));
    }
  leap_xy_ = std::max(kLeast_m, kLeap * mostAreWithin(distances));
  leap_phi_ = std::max(kLeast_rad, kLeap * mostAreWithin(turns));
}

std::optional<DoubtfulStep> DoubtfulSteps::find(const LocalPath& path, std::size_t begin, std::size_t from,
                                                std::size_t to, bool last) const {
  for (std::size_t i = from + 1; i <= to; ++i) {
    const std::size_t strays = scansThatFitNothing(path, i - begin);
    if (limits_.carried && (strays > kStrayScans || (last && i == to && strays > 0)))
      return DoubtfulStep{i + 1 - strays, {kAnywhere_m, kAnywhere_m, kAnywhere_rad}};
    if (const auto off = contradiction(path, begin, i)) return DoubtfulStep{i, *off};
  }
  return std::nullopt;
}

bool DoubtfulSteps::isLeap(const TPose2D& step) const {
  return distanceOf(step) > leap_xy_ || turnOf(step) > leap_phi_;
}

/** Standard deviations of the step that ends at frame i, if scans and odometry say quite different things of
 * it. Odometry may also be right since it was right last: where it catches up. */
std::optional<Eigen::Vector3d> DoubtfulSteps::contradiction(const LocalPath& path, std::size_t begin,
                                                            std::size_t i) const {
  const auto matched = [&](std::size_t k) { return path[i - begin].pose - path[k - begin].pose; };
  const auto off = [&](std::size_t k) {
    const TPose2D by = matched(k) - *incrementBetween(frames_[k], frames_[i]);
    return Eigen::Vector3d(by.x, by.y, mrpt::math::wrapToPi(by.phi));
  };
  const auto isFar = [&](const Eigen::Vector3d& by) {
    return by.head<2>().norm() > limits_.doubtful_step_xy || std::abs(by.z()) > limits_.doubtful_step_phi;
  };
  const auto odometry = incrementBetween(frames_[i - 1], frames_[i]);
  if (!odometry || !(isLeap(*odometry) || isLeap(matched(i - 1)))) return std::nullopt;
  const Eigen::Vector3d by = off(i - 1);
  if (!isFar(by)) return std::nullopt;
  std::size_t agreed = i - 1;
  while (agreed > begin && !path[agreed - begin].by_odometry) --agreed;
  if (frames_[agreed].odometry && !isFar(off(agreed))) return std::nullopt;
  return 0.5 * by;  // the truth is somewhere between the two
}

}  // namespace submap_slam
