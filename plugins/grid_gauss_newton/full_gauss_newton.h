#pragma once

#include <Eigen/Sparse>
#include <optional>

#include "jacobian.h"
#include "lattice.h"
#include "pose_system.h"

namespace submap_slam::grid_joining {

/** The problem of eq. (4) written out with one row for each observation (cell, submap) and one column for
 * each unknown: the reference that the fused kernel is checked and timed against. F = map_jacobian · M −
 * values. */
struct ExplicitProblem {
  Eigen::SparseMatrix<double>
      pose_jacobian;  ///< ∂L/∂X: observations × 3 frames, rows J_i; J_r of the paper is its negative
  Eigen::SparseMatrix<double> map_jacobian;  ///< J_M: observations × observed cells, entries ω_ij (eq. 5)
  Eigen::VectorXd values;                    ///< H: L_i(p_ij)
};

/** Writes the problem out at the given frames, over all cells that any submap sees. */
ExplicitProblem writeOut(const EvidenceLevels& level, const Frames& frames, JacobianKind jacobian,
                         double lattice_angle);

/** A step in which the map is an unknown as well. */
struct FullStep {
  Eigen::VectorXd frames;  ///< Δ of the frames, 0 for held ones
  Eigen::VectorXd map;     ///< Δ of the map
};

/** Gauss-Newton step of eq. (6) over frames and map together by sparse Cholesky (CHOLMOD).
 * @param map         M(k), any values: the frames' step does not depend on it
 * @param pose_terms  added to the normal equations of the frames (prior, damping), in units of the evidence
 * cost
 * @return empty if the matrix is not positive definite */
std::optional<FullStep> fullStep(const ExplicitProblem& problem, const Eigen::VectorXd& map,
                                 const PoseSystem& pose_terms, const std::vector<bool>& held);

/** The same step of the frames from eq. (13) with explicit sparse products. */
std::optional<Eigen::VectorXd> poseOnlyStep(const ExplicitProblem& problem, const PoseSystem& pose_terms,
                                            const std::vector<bool>& held);

}  // namespace submap_slam::grid_joining
