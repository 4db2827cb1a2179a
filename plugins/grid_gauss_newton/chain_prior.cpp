#include "chain_prior.h"

#include <mrpt/math/wrap2pi.h>

#include <cmath>

#include "jacobian.h"

namespace submap_slam::grid_joining {
namespace {

/** No end pose is believed beyond 1 mm and 0.1 mrad; it also makes covariances without noise in some
 * direction regular. */
const Eigen::Vector3d kSmallestVariance(1e-6, 1e-6, 1e-8);

}  // namespace

ChainPrior::ChainPrior(const GridSubmaps& submaps, double weight) {
  if (weight <= 0) return;
  for (std::size_t k = 0; k + 1 < submaps.size(); ++k) {
    const GridSubmap& submap = *submaps[k];
    if (!submap.has_successor) continue;
    Eigen::Matrix3d covariance = submap.end_pose.cov.asEigen();
    covariance.diagonal() += kSmallestVariance;
    const Eigen::Matrix3d information = weight * covariance.inverse();
    links_.push_back({k, submap.end_pose.mean.asTPose(), 0.5 * (information + information.transpose())});
  }
}

Eigen::Vector3d ChainPrior::residual(const Link& link, const Frames& frames) {
  const auto &a = frames[link.from], &b = frames[link.from + 1];
  const Eigen::Vector3d seen =
      globalToLocalMotion(a.phi) * Eigen::Vector3d(b.x - a.x, b.y - a.y, b.phi - a.phi);
  return {seen.x() - link.T_a_b.x, seen.y() - link.T_a_b.y, mrpt::math::wrapToPi(seen.z() - link.T_a_b.phi)};
}

double ChainPrior::cost(const Frames& frames) const {
  double sum = 0;
  for (const Link& link : links_) {
    const Eigen::Vector3d e = residual(link, frames);
    sum += e.dot(link.information * e);
  }
  return sum;
}

PoseSystem ChainPrior::linearise(const Frames& frames) const {
  PoseSystem system(frames.size());
  for (const Link& link : links_) {
    const std::size_t i = link.from, k = i + 1;
    const Eigen::Vector3d e = residual(link, frames);
    const Eigen::Matrix3d to = globalToLocalMotion(frames[i].phi);
    Eigen::Matrix3d from = -to;
    from(0, 2) = e.y() + link.T_a_b.y;
    from(1, 2) = -(e.x() + link.T_a_b.x);
    system.gradient[i] += from.transpose() * link.information * e;
    system.gradient[k] += to.transpose() * link.information * e;
    system.addBlock(i, i, from.transpose() * link.information * from);
    system.addBlock(i, k, from.transpose() * link.information * to);
    system.addBlock(k, k, to.transpose() * link.information * to);
  }
  return system;
}

}  // namespace submap_slam::grid_joining
