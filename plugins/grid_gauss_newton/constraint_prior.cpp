#include "constraint_prior.h"

#include <submap_slam/core/relative_pose.h>

#include <cstdint>
#include <map>

namespace submap_slam::grid_joining {
namespace {

/** No constraint is believed beyond 1 mm and 0.1 mrad; it also makes covariances without noise in some
 * direction regular. */
const Eigen::Vector3d kSmallestVariance(1e-6, 1e-6, 1e-8);

}  // namespace

ConstraintPrior::ConstraintPrior(const std::vector<Constraint>& constraints, const GridSubmaps& submaps,
                                 double weight) {
  if (weight <= 0) return;
  std::map<uint32_t, std::size_t> frame_of;
  for (std::size_t k = 0; k < submaps.size(); ++k) frame_of.emplace(submaps[k]->id, k);
  for (const Constraint& constraint : constraints) {
    const auto from = frame_of.find(constraint.from), to = frame_of.find(constraint.to);
    if (!constraint.accepted || from == frame_of.end() || to == frame_of.end()) continue;
    Eigen::Matrix3d covariance = constraint.T_a_b.cov.asEigen();
    covariance.diagonal() += kSmallestVariance;
    const Eigen::Matrix3d information = weight * covariance.inverse();
    links_.push_back({from->second, to->second, constraint.T_a_b.mean.asTPose(),
                      0.5 * (information + information.transpose())});
  }
}

double ConstraintPrior::cost(const Frames& frames) const {
  double sum = 0;
  for (const Link& link : links_) {
    const Eigen::Vector3d e = relationError(frames[link.from], frames[link.to], link.T_a_b).e;
    sum += e.dot(link.information * e);
  }
  return sum;
}

PoseSystem ConstraintPrior::linearise(const Frames& frames) const {
  PoseSystem system(frames.size());
  for (const Link& link : links_) {
    const std::size_t i = link.from, k = link.to;
    const auto [e, from, to] = relationError(frames[i], frames[k], link.T_a_b);
    system.gradient[i] += from.transpose() * link.information * e;
    system.gradient[k] += to.transpose() * link.information * e;
    system.addBlock(i, i, from.transpose() * link.information * from);
    system.addBlock(i, k, from.transpose() * link.information * to);
    system.addBlock(k, k, to.transpose() * link.information * to);
  }
  return system;
}

}  // namespace submap_slam::grid_joining
