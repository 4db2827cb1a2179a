#include "odometry_model.h"

#include <mrpt/math/wrap2pi.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include <submap_slam/core/relative_pose.h>

namespace submap_slam::pose_graph {
namespace {

using mrpt::math::TPose2D;

/** Fewer steps say too little of a log. */
constexpr std::size_t kFewestSteps = 30;
/** Over so many steps errors of odometry stand out from those of matches. */
constexpr std::size_t kManySteps = 8;
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
  double heading;  ///< of the robot at its begin, in the submap (rad)
};

/** Steps without a gap, all of one submap. */
using Run = std::vector<Step>;

std::vector<Run> runsOf(const GridSubmaps& submaps, const GraphNodes& nodes) {
  std::vector<Run> runs;
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    runs.emplace_back();
    for (std::size_t g = 1; g < nodes[k].size(); ++g) {
      const SubmapNode &a = submaps[k]->nodes[nodes[k][g - 1]], &b = submaps[k]->nodes[nodes[k][g]];
      if (const auto odometry = odometryBetween(a, b))
        runs.back().push_back({b.pose - a.pose, *odometry, a.pose.phi});
      else
        runs.emplace_back();
    }
  }
  return runs;
}

/** A gain beyond these says that something else is wrong. */
double plausible(double gain) { return gain > 0.5 && gain < 2 ? gain : 1; }

/** Steps are chosen by what the scans say: those where odometry's own noise is large would pull the gains to
 * 0. */
void estimateGains(OdometryModel& model, const std::vector<Run>& runs) {
  std::vector<double> xy, phi;
  for (const Run& run : runs)
    for (const Step& step : run) {
      const double moved = std::hypot(step.matched.x, step.matched.y);
      const double turned = mrpt::math::wrapToPi(step.matched.phi);
      if (moved > kShortest_m) xy.push_back(std::hypot(step.odometry.x, step.odometry.y) / moved);
      if (std::abs(turned) > kSmallest_rad) phi.push_back(mrpt::math::wrapToPi(step.odometry.phi) / turned);
    }
  if (xy.size() >= kFewestSteps) model.gain_xy = plausible(1 / quantile(xy, 0.5));
  if (phi.size() >= kFewestSteps) model.gain_phi = plausible(1 / quantile(phi, 0.5));
}

/** By how much odometry and scans differ over some steps, and how long these are. */
struct Spread {
  std::size_t samples = 0;
  double length = 0;       ///< mean, see odometryLength
  double xy = 0, phi = 0;  ///< variances (m², rad²) by their worst tenth
};

/** Over all stretches of `lag` steps. Each step is turned as the scans say, so that errors of the heading do
 * not pass for such of the way. */
Spread spreadOver(std::size_t lag, const OdometryModel& model, const std::vector<Run>& runs) {
  Spread spread;
  std::vector<double> xy, phi;
  for (const Run& run : runs) {
    std::vector<Eigen::Vector4d> sums{Eigen::Vector4d::Zero()};  // e in the axes of the submap, and length
    for (const Step& step : run) {
      const Eigen::Vector3d e = relationError({}, step.matched, model.corrected(step.odometry)).e;
      Eigen::Vector4d sum = sums.back();
      sum.head<2>() += Eigen::Rotation2Dd(step.heading) * e.head<2>();
      sum[2] += e.z();
      sum[3] += odometryLength(step.matched);
      sums.push_back(sum);
    }
    for (std::size_t n = lag; n < sums.size(); ++n) {
      const Eigen::Vector4d over = sums[n] - sums[n - lag];
      xy.push_back(over.head<2>().squaredNorm());
      phi.push_back(over[2] * over[2]);
      spread.length += over[3];
    }
  }
  spread.samples = xy.size();
  if (xy.empty()) return spread;
  spread.length /= static_cast<double>(xy.size());
  spread.xy = quantile(xy, kWorst) / kChi2Two;
  spread.phi = quantile(phi, kWorst) / kChi2One;
  return spread;
}

/** Errors of odometry add up along the way; those of matches, of each by itself, do not. So odometry's are
 * what the spread grows by, and what single steps have beyond the errors of matches; at most all of it, as in
 * logs of submaps too short for that. */
void estimateVariances(OdometryModel& model, const std::vector<Run>& runs, const MatchNoise& match) {
  const Spread one = spreadOver(1, model, runs), many = spreadOver(kManySteps, model, runs);
  if (one.samples < kFewestSteps || one.length <= 0) return;
  const auto perLength = [&](double Spread::*variance, double sigma_of_match) {
    const double at_most = one.*variance / one.length;
    if (many.samples < kFewestSteps || many.length <= one.length) return at_most;
    const double beyond_matches = at_most - 2 * sigma_of_match * sigma_of_match / one.length;
    const double growth = (many.*variance - one.*variance) / (many.length - one.length);
    return std::min(at_most, std::max(beyond_matches, growth));
  };
  model.steps = one.samples;
  model.variance_xy = std::max(kLeastVarianceXy, perLength(&Spread::xy, match.sigma_xy));
  model.variance_phi = std::max(kLeastVariancePhi, perLength(&Spread::phi, match.sigma_phi));
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

OdometryModel odometryModelOf(const GridSubmaps& submaps, const GraphNodes& nodes, const MatchNoise& match) {
  const std::vector<Run> runs = runsOf(submaps, nodes);
  OdometryModel model;
  estimateGains(model, runs);
  estimateVariances(model, runs, match);
  return model;
}

}  // namespace submap_slam::pose_graph
