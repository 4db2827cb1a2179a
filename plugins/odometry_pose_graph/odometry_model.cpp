#include "odometry_model.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>

#include <submap_slam/core/relative_pose.h>

namespace submap_slam::pose_graph {
namespace {

using mrpt::math::TPose2D;

/** Fewer steps say too little of a log. */
constexpr std::size_t kFewestSteps = 30;
/** Steps that are shorter tell nothing of the gains. */
constexpr double kShortest_m = 0.05, kSmallest_rad = 0.05;
/** Odometry is not believed beyond 1 mm and 0.2 mrad over a metre. */
constexpr double kLeastVarianceXy = 1e-6, kLeastVariancePhi = 4e-8;
/** Odometry may err at some steps only: its variance is read from the worst tenth, which slips seldom reach.
 * Quantiles of χ² with one and two degrees of freedom there. */
constexpr double kWorst = 0.9, kChi2One = 2.7055, kChi2Two = 4.6052;

/** @param share in [0, 1) */
double quantile(std::vector<double>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/** A step between two graph nodes as both see it. */
struct Step {
  TPose2D matched, odometry;
};

std::vector<Step> stepsOf(const GridSubmaps& submaps, const GraphNodes& nodes) {
  std::vector<Step> steps;
  for (std::size_t k = 0; k < submaps.size(); ++k)
    for (std::size_t g = 1; g < nodes[k].size(); ++g) {
      const SubmapNode &a = submaps[k]->nodes[nodes[k][g - 1]], &b = submaps[k]->nodes[nodes[k][g]];
      if (const auto odometry = odometryBetween(a, b)) steps.push_back({b.pose - a.pose, *odometry});
    }
  return steps;
}

/** A gain beyond these says that something else is wrong. */
double plausible(double gain) { return gain > 0.5 && gain < 2 ? gain : 1; }

/** Steps are chosen by what the scans say: those where odometry's own noise is large would pull the gains to
 * 0. */
void estimateGains(OdometryModel& model, const std::vector<Step>& steps) {
  std::vector<double> xy, phi;
  for (const Step& step : steps) {
    const double moved = std::hypot(step.matched.x, step.matched.y);
    const double turned = mrpt::math::wrapToPi(step.matched.phi);
    if (moved > kShortest_m) xy.push_back(std::hypot(step.odometry.x, step.odometry.y) / moved);
    if (std::abs(turned) > kSmallest_rad) phi.push_back(mrpt::math::wrapToPi(step.odometry.phi) / turned);
  }
  if (xy.size() >= kFewestSteps) model.gain_xy = plausible(1 / quantile(xy, 0.5));
  if (phi.size() >= kFewestSteps) model.gain_phi = plausible(1 / quantile(phi, 0.5));
}

void estimateVariances(OdometryModel& model, const std::vector<Step>& steps) {
  std::vector<double> xy, phi;
  for (const Step& step : steps) {
    const double length = odometryLength(step.matched);
    if (length <= 0) continue;
    const Eigen::Vector3d e = relationError({}, step.matched, model.corrected(step.odometry)).e;
    xy.push_back(e.head<2>().squaredNorm() / length);
    phi.push_back(e.z() * e.z() / length);
  }
  if (xy.size() < kFewestSteps) return;
  model.steps = xy.size();
  model.variance_xy = std::max(kLeastVarianceXy, quantile(xy, kWorst) / kChi2Two);
  model.variance_phi = std::max(kLeastVariancePhi, quantile(phi, kWorst) / kChi2One);
}

}  // namespace

GraphNodes graphNodesOf(const GridSubmaps& submaps, double distance, double angle) {
  GraphNodes all(submaps.size());
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    const auto& nodes = submaps[k]->nodes;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const TPose2D moved = all[k].empty() ? TPose2D() : nodes[n].pose - nodes[all[k].back()].pose;
      const bool far =
          std::hypot(moved.x, moved.y) >= distance || std::abs(mrpt::math::wrapToPi(moved.phi)) >= angle;
      if (n == 0 || far) all[k].push_back(n);
    }
  }
  return all;
}

std::optional<TPose2D> odometryBetween(const SubmapNode& a, const SubmapNode& b) {
  if (!a.odometry || !b.odometry) return std::nullopt;
  return *b.odometry - *a.odometry;
}

double odometryLength(const TPose2D& motion) {
  constexpr double kLever_m = 0.3;
  return std::hypot(motion.x, motion.y) + kLever_m * std::abs(mrpt::math::wrapToPi(motion.phi));
}

TPose2D OdometryModel::corrected(const TPose2D& odometry) const {
  return {gain_xy * odometry.x, gain_xy * odometry.y, gain_phi * mrpt::math::wrapToPi(odometry.phi)};
}

Eigen::Matrix3d OdometryModel::covariance(double length) const {
  return Eigen::Vector3d(variance_xy * length, variance_xy * length, variance_phi * length).asDiagonal();
}

OdometryModel odometryModelOf(const GridSubmaps& submaps, const GraphNodes& nodes) {
  const std::vector<Step> steps = stepsOf(submaps, nodes);
  OdometryModel model;
  estimateGains(model, steps);
  estimateVariances(model, steps);
  return model;
}

}  // namespace submap_slam::pose_graph
