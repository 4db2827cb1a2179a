#pragma once

#include <Eigen/Core>
#include <cmath>

#include "pyramid.h"

namespace submap_slam::grid_joining {

/** Which derivative of the evidence the rows J_i are made of; m = Σ w_k L_k / Σ w_k² is the cell's joint
 * value per hit. */
enum class JacobianKind {
  kPaper,               ///< ∇L_i: the paper's J_r, which takes the hit counts for constant
  kVariableProjection,  ///< ∇L_i − m ∇N_i: exact gradient of the reduced cost
  kSurface  ///< ∇L_i − (L_i/N_i) ∇N_i: zero in uniform space; widest basin, biased fixed point
};

/** Gradient (per metre, local map frame) that takes the place of ∇L_i. */
inline Eigen::Vector2d effectiveGradient(JacobianKind kind, const EvidenceSample& s, double joint_value) {
  const double share = kind == JacobianKind::kPaper                ? 0
                       : kind == JacobianKind::kVariableProjection ? joint_value
                                                                   : s.log_odds / s.hits;
  return {s.log_odds_gradient[0] - share * s.hits_gradient[0],
          s.log_odds_gradient[1] - share * s.hits_gradient[1]};
}

/** Row ∂L_i/∂(δx, δy, θ), the translation taken along the submap's own axes; p = point in the local map frame
 * (m). */
inline Eigen::Vector3d localJacobian(const Eigen::Vector2d& gradient, double px, double py) {
  return {-gradient.x(), -gradient.y(), gradient.x() * py - gradient.y() * px};
}

/** Turns a motion of the frame given in the global map frame into one along the submap's own axes. */
inline Eigen::Matrix3d globalToLocalMotion(double heading) {
  const double c = std::cos(heading), s = std::sin(heading);
  Eigen::Matrix3d motion;
  motion << c, s, 0, -s, c, 0, 0, 0, 1;
  return motion;
}

}  // namespace submap_slam::grid_joining
