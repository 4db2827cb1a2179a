#pragma once

#include <cstddef>

#include "jacobian.h"
#include "lane_kernel.h"
#include "lattice.h"
#include "pose_system.h"

namespace submap_slam::grid_joining {

/** The joint problem after the map has been eliminated (eq. 13), summed over all cells that two or more
 * submaps see and where at least one of them sees evidence above the background: the others add nothing. */
struct ReducedSystem {
  explicit ReducedSystem(std::size_t frames) : system(frames) {}

  /** Σ_j Σ_i (L_i − w_i m_j)², w_i = N_i: f of eq. (4) at the best map for these frames. */
  double cost = 0;

  double energy = 0;             ///< Σ_j Σ_i L_i²
  std::size_t observations = 0;  ///< (cell, submap) pairs in the sums
  std::size_t cells = 0;         ///< cells in the sums

  PoseSystem system;  ///< J^T(I − ww^T/W)J and J^T(L − w m)
};

/** Evaluates cost and normal equations at the given frames, one (1×3) row J_i per cell and submap:
 *    block(i,k) += J_iᵀ(δ_ik − w_i w_k/W) J_k,  gradient(i) += J_iᵀ(L_i − w_i m),  W = Σ w²,  m = Σ w_k
 * L_k/W. Parallel; the sums are taken in a fixed order, so the result has the same bits for any number of
 * threads.
 * @tparam Scalar of look-ups and of the sums within a tile of the lattice, float (half the time) or double;
 * tiles are always added up in double */
template <class Scalar>
ReducedSystem reduce(const PlacedLevels& placed, const Frames& frames, JacobianKind jacobian,
                     InstructionSet instructions = bestInstructionSet());

extern template ReducedSystem reduce<float>(const PlacedLevels&, const Frames&, JacobianKind, InstructionSet);
extern template ReducedSystem reduce<double>(const PlacedLevels&, const Frames&, JacobianKind,
                                             InstructionSet);

/** Σ_j Σ_{i<k} w_i² w_k² / Σ w² over all cells: the weight with which differences of two submaps enter the
 * cost. cost / overlapWeight is the mean squared difference of log-odds per hit, comparable between frames
 * with different overlap.
 * @param stride only each stride-th lattice point along both axes is looked at, and counts for all */
double overlapWeight(const PlacedLevels& placed, int stride = 4);

}  // namespace submap_slam::grid_joining
