#include <submap_slam/mapping/local_path.h>

#include <mrpt/math/wrap2pi.h>
#include <mrpt/poses/CPose2D.h>

#include <algorithm>
#include <cmath>

namespace submap_slam {

using mrpt::math::TPose2D;

Eigen::Matrix3d motionInformation(const MotionParams& p, const TPose2D& increment) {
  const double distance = std::hypot(increment.x, increment.y),
               turn = std::abs(mrpt::math::wrapToPi(increment.phi));
  const double sigma_xy = p.sigma_xy + p.sigma_xy_per_m * distance;
  const double sigma_phi = p.sigma_phi + p.sigma_phi_per_rad * turn + p.sigma_phi_per_m * distance;
  return Eigen::Vector3d(1 / (sigma_xy * sigma_xy), 1 / (sigma_xy * sigma_xy), 1 / (sigma_phi * sigma_phi))
      .asDiagonal();
}

TPose2D lastIncrement(const LocalPath& path) {
  const auto n = path.size();
  if (n < 2) return {};
  return path[n - 1].pose - path[n - 2].pose;
}

double usualInlierShare(const LocalPath& path, std::size_t end) {
  constexpr std::size_t kScans = 10;
  const std::size_t n = std::min(kScans, end);
  double sum = 0;
  for (std::size_t k = end - n; k < end; ++k) sum += static_cast<double>(path[k].inlier_share);
  return sum / static_cast<double>(n);
}

bool isKeyPose(const LocalPath& path, const TPose2D& pose, const KeyParams& keys) {
  const auto last_key = std::find_if(path.rbegin(), path.rend(), [](const auto& node) { return node.key; });
  if (last_key == path.rend()) return true;
  const TPose2D moved = pose - last_key->pose;
  return std::hypot(moved.x, moved.y) >= keys.distance ||
         std::abs(mrpt::math::wrapToPi(moved.phi)) >= keys.angle;
}

}  // namespace submap_slam
