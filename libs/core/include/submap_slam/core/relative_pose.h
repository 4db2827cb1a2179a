#pragma once

#include <mrpt/math/TPose2D.h>
#include <Eigen/Core>

namespace submap_slam {

/** What a measured relation of two poses says, linearised (Huang et al. 2024, eq. 6 and 11):
 *
 *     e = [R_aᵀ (t_b − t_a) − t̂ ; wrap(θ_b − θ_a − θ̂)].
 */
struct RelationError {
  Eigen::Vector3d e;           ///< m, m, rad; in the axes of a
  Eigen::Matrix3d to_a, to_b;  ///< ∂e/∂(x, y, θ) of both poses
};

RelationError relationError(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b,
                            const mrpt::math::TPose2D& T_a_b);

/** Of a relation with these standard deviations (m, rad), independent of each other. */
Eigen::Matrix3d variances(double sigma_xy, double sigma_phi);

/** Lᵀ of the information Ω = L Lᵀ of a covariance, which weights a residual: ‖Lᵀ e‖² = eᵀ Ω e. */
Eigen::Matrix3d squareRootInformation(const Eigen::Matrix3d& covariance);

}  // namespace submap_slam
