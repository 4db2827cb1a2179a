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
/** Graph nodes of a long step: a metre, over which a slip is still unlikely. */
constexpr std::size_t kSeveral = 4;
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

/** All steps over this many graph nodes. */
std::vector<Step> stepsOf(const GridSubmaps& submaps, const GraphNodes& nodes, std::size_t lag) {
  std::vector<Step> steps;
  for (std::size_t k = 0; k < submaps.size(); ++k)
    for (std::size_t g = lag; g < nodes[k].size(); ++g) {
      const SubmapNode &a = submaps[k]->nodes[nodes[k][g - lag]], &b = submaps[k]->nodes[nodes[k][g]];
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

/** How much odometry and scans disagree over steps of a kind: variances, read where slips seldom reach. */
struct Disagreement {
  std::size_t steps = 0;
  double length = 0;                   ///< mean, see odometryLength
  double xy = 0, phi = 0;              ///< m² along each axis, rad²
  double xy_per_m = 0, phi_per_m = 0;  ///< the same of e² / length
};

Disagreement disagreementOf(const OdometryModel& model, const std::vector<Step>& steps) {
  std::vector<double> xy, phi, xy_per_m, phi_per_m;
  Disagreement out;
  for (const Step& step : steps) {
    const double length = odometryLength(step.matched);
    if (length <= 0) continue;
    const Eigen::Vector3d e = relationError({}, step.matched, model.corrected(step.odometry)).e;
    out.length += length;
    xy.push_back(e.head<2>().squaredNorm());
    phi.push_back(e.z() * e.z());
    xy_per_m.push_back(xy.back() / length);
    phi_per_m.push_back(phi.back() / length);
  }
  out.steps = xy.size();
  if (xy.empty()) return out;
  out.length /= static_cast<double>(xy.size());
  out.xy = quantile(xy, kWorst) / kChi2Two;
  out.phi = quantile(phi, kWorst) / kChi2One;
  out.xy_per_m = quantile(xy_per_m, kWorst) / kChi2Two;
  out.phi_per_m = quantile(phi_per_m, kWorst) / kChi2One;
  return out;
}

/** The error of a matched pose is another one at each node, that of odometry adds up along the path. So over
 * steps of length ℓ they disagree by 2 m + v ℓ, m the variance of a match and v that of odometry, both found
 * from steps of two lengths. */
void estimateVariances(OdometryModel& model, const Disagreement& one, const Disagreement& several) {
  model.steps = one.steps;
  const double longer = several.length - one.length;
  const auto perLength = [longer](double at_one, double at_several, double at_most, double at_least) {
    const double slope = longer > 0 ? (at_several - at_one) / longer : at_most;
    return std::max(at_least, std::min(slope, at_most));
  };
  model.variance_xy = perLength(one.xy, several.xy, one.xy_per_m, kLeastVarianceXy);
  model.variance_phi = perLength(one.phi, several.phi, one.phi_per_m, kLeastVariancePhi);
  model.node_variance_xy = std::max(0.0, one.xy - model.variance_xy * one.length) / 2;
  model.node_variance_phi = std::max(0.0, one.phi - model.variance_phi * one.length) / 2;
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
  const std::vector<Step> steps = stepsOf(submaps, nodes, 1);
  OdometryModel model;
  estimateGains(model, steps);
  const Disagreement one = disagreementOf(model, steps);
  if (one.steps < kFewestSteps) return model;
  estimateVariances(model, one, disagreementOf(model, stepsOf(submaps, nodes, kSeveral)));
  return model;
}

}  // namespace submap_slam::pose_graph
