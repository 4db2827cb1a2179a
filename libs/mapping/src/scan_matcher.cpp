#include <submap_slam/mapping/scan_matcher.h>

#include <mrpt/math/wrap2pi.h>
#include <Eigen/Cholesky>

#include <cmath>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** A beam counts as explained by the map within this many sigmas. */
constexpr double kInlierSigmas = 2.0;
constexpr double kConvergedStepM = 1e-4, kConvergedStepRad = 2e-5, kConvergedDecrease = 1e-4;
/** A start that explains fewer beams than this is first improved with a softer loss, which has a wider basin.
 */
constexpr double kSoftStartBelow = 0.7, kSoftness = 3.0;

Eigen::Vector3d difference(const TPose2D& a, const TPose2D& b) {
  return {a.x - b.x, a.y - b.y, mrpt::math::wrapToPi(a.phi - b.phi)};
}

TPose2D moved(const TPose2D& pose, const Eigen::Vector3d& step) {
  return {pose.x + step.x(), pose.y + step.y(), mrpt::math::wrapToPi(pose.phi + step.z())};
}

/** Accumulates robust rows of the normal equations; the upper triangle of H suffices. */
struct NormalEquations {
  double cost_log = 0;  ///< Σ log(1 + r²/c²)
  double h00 = 0, h01 = 0, h02 = 0, h11 = 0, h12 = 0, h22 = 0, g0 = 0, g1 = 0, g2 = 0;

  void add(double r, double weight, double jx, double jy, double jphi) {
    const double wx = weight * jx, wy = weight * jy, wp = weight * jphi;
    h00 += wx * jx;
    h01 += wx * jy;
    h02 += wx * jphi;
    h11 += wy * jy;
    h12 += wy * jphi;
    h22 += wp * jphi;
    g0 += wx * r;
    g1 += wy * r;
    g2 += wp * r;
  }
};

}  // namespace

ScanMatcher::ScanMatcher(const MatcherParams& params, double search_radius) : params_(params) {
  const double c2 = params.cauchy_scale * params.cauchy_scale;
  const double r = search_radius / params.line_sigma;
  unmatched_cost_ = 0.5 * c2 * std::log1p(r * r / c2);
}

ScanMatcher::Evaluation ScanMatcher::evaluate(const SurfelMap& map, const LaserPoints& scan,
                                              const TPose2D& pose, double softness) const {
  const double c = std::cos(pose.phi), s = std::sin(pose.phi);
  const auto cf = static_cast<float>(c), sf = static_cast<float>(s);
  const double inverse_sigma = 1.0 / (softness * params_.line_sigma);
  const double c2 = params_.cauchy_scale * params_.cauchy_scale, inverse_c2 = 1.0 / c2;
  const double max_inlier_r2 = kInlierSigmas * kInlierSigmas / (softness * softness);
  NormalEquations sums;
  std::size_t unmatched = 0, inliers = 0;
  double product = 1.0;  // of 1 + r²/c²; its logarithm is taken once in a while
  for (const auto& p : scan.points) {
    const double px = static_cast<double>(p.x), py = static_cast<double>(p.y);
    const double rx = c * px - s * py, ry = s * px + c * py;  // beam turned into the map frame
    const double x = pose.x + rx, y = pose.y + ry;
    const Surfel* surfel = map.nearest(x, y);
    const float normal_x = cf * p.normal_x - sf * p.normal_y, normal_y = sf * p.normal_x + cf * p.normal_y;
    if (!surfel || surfel->facesAwayFrom(normal_x, normal_y)) {
      ++unmatched;
      continue;
    }
    const double dx = (x - static_cast<double>(surfel->line_x)) * inverse_sigma;
    const double dy = (y - static_cast<double>(surfel->line_y)) * inverse_sigma;
    const double nx = static_cast<double>(surfel->normal_x), ny = static_cast<double>(surfel->normal_y);
    const bool is_line = surfel->kind == Surfel::Kind::kLine;
    const double r = nx * dx + ny * dy;
    const double r2 = is_line ? r * r : dx * dx + dy * dy;
    const double robust = 1.0 + r2 * inverse_c2;
    const double weight = 1.0 / robust;  // ρ'(r²) of the Cauchy loss
    product *= robust;
    if (product > 1e200) {
      sums.cost_log += std::log(product);
      product = 1.0;
    }
    if (r2 < max_inlier_r2) ++inliers;
    // ∂(T p)/∂φ = (−ry, rx)
    if (is_line) {
      sums.add(r, weight, nx * inverse_sigma, ny * inverse_sigma, (ny * rx - nx * ry) * inverse_sigma);
    } else {
      sums.add(dx, weight, inverse_sigma, 0, -ry * inverse_sigma);
      sums.add(dy, weight, 0, inverse_sigma, rx * inverse_sigma);
    }
  }
  sums.cost_log += std::log(product);

  Evaluation out;
  out.cost = 0.5 * c2 * sums.cost_log + unmatched_cost_ * static_cast<double>(unmatched);
  out.gradient << sums.g0, sums.g1, sums.g2;
  out.hessian << sums.h00, sums.h01, sums.h02, sums.h01, sums.h11, sums.h12, sums.h02, sums.h12, sums.h22;
  out.inliers = inliers;
  return out;
}

MatchResult ScanMatcher::match(const SurfelMap& map, const LaserPoints& scan, const PosePrior& prior,
                               const TPose2D& start) const {
  const auto few = static_cast<std::size_t>(kSoftStartBelow * static_cast<double>(scan.points.size()));
  const Evaluation at_start = evaluate(map, scan, start);
  if (at_start.inliers >= few) return minimise(map, scan, prior, start, at_start, 1.0);
  const MatchResult soft =
      minimise(map, scan, prior, start, evaluate(map, scan, start, kSoftness), kSoftness);
  return minimise(map, scan, prior, soft.pose, evaluate(map, scan, soft.pose), 1.0);
}

MatchResult ScanMatcher::minimise(const SurfelMap& map, const LaserPoints& scan, const PosePrior& prior,
                                  const TPose2D& start, Evaluation at, double softness) const {
  const auto priorCost = [&](const TPose2D& p) {
    const Eigen::Vector3d d = difference(p, prior.mean);
    return 0.5 * d.dot(prior.information * d);
  };
  MatchResult best;
  best.pose = start;
  best.cost = at.cost + priorCost(start);
  double damping = 1e-6;
  for (best.iterations = 0; best.iterations < params_.max_iterations; ++best.iterations) {
    const Eigen::Vector3d gradient = at.gradient + prior.information * difference(best.pose, prior.mean);
    Eigen::Matrix3d system = at.hessian + prior.information;
    system.diagonal() *= 1.0 + damping;
    const Eigen::Vector3d step = -system.ldlt().solve(gradient);
    if (!step.allFinite()) break;
    const TPose2D candidate = moved(best.pose, step);
    const Evaluation there = evaluate(map, scan, candidate, softness);
    const double cost = there.cost + priorCost(candidate);
    const double decrease = best.cost - cost;
    if (decrease >= 0) {
      best.pose = candidate;
      best.cost = cost;
      at = there;
      damping *= 0.1;
    } else {
      damping = std::max(damping, 1e-4) * 30;
    }
    const bool small_step = step.head<2>().norm() < kConvergedStepM && std::abs(step.z()) < kConvergedStepRad;
    if (small_step || (decrease >= 0 && decrease < kConvergedDecrease * best.cost)) break;
  }
  best.information = at.hessian;
  const std::size_t beams = scan.points.size();
  best.inlier_share = beams ? static_cast<double>(at.inliers) / static_cast<double>(beams) : 0.0;
  return best;
}

}  // namespace submap_slam
