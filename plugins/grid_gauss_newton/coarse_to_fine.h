#pragma once

#include <optional>
#include <string>
#include <vector>

#include "levenberg_marquardt.h"
#include "observability.h"

namespace submap_slam::grid_joining {

/** How the step of one iteration is found; all three give the same step. */
enum class SolverKind {
  kPoseOnly,          ///< fused kernel: the reduced system summed cell by cell
  kExplicitPoseOnly,  ///< eq. (13) with explicit sparse matrices
  kFull               ///< eq. (6) over frames and map
};

struct CoarseToFineOptions {
  LevenbergMarquardtOptions iteration;
  SolverKind solver = SolverKind::kPoseOnly;
  JacobianKind finest_jacobian = JacobianKind::kVariableProjection;
  JacobianKind coarse_jacobian = JacobianKind::kSurface;
  double lattice_angle = 0.41;    ///< rad
  double correlation_length = 1;  ///< m, see estimateEvidenceVariance
};

struct CoarseToFineResult {
  JoinStatus status = JoinStatus::kNothingToJoin;
  std::string reason;
  Frames frames;  ///< the given ones unless the status is kConverged or kIterationLimit

  /** Marginal covariance of (x, y, θ) in the global map frame, from the inverse of the reduced system; empty
   * for submaps that nothing connects to the first one. */
  std::vector<std::optional<Eigen::Matrix3d>> covariances;

  std::vector<std::size_t> groups;             ///< see groupsOf; empty unless joined
  std::vector<OpenDirection> open_directions;  ///< of all groups

  double objective = 0;  ///< F at `frames` at the finest level, with the evidence variance found there
  std::vector<JoinIteration> iterations;
};

/** Joins from the coarsest level to the finest. What a coarse level found is kept only if it lowers the
 * objective at the finest level, for equal overlap; a final result that is no better than the start is
 * refused.
 * @param pyramid finest level first */
CoarseToFineResult joinCoarseToFine(const std::vector<EvidenceLevels>& pyramid, const Frames& start,
                                    const ConstraintPrior& prior, const CoarseToFineOptions& options,
                                    const IterationCallback& callback);

}  // namespace submap_slam::grid_joining
