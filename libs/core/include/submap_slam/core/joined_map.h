#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <submap_slam/core/frame.h>
#include <submap_slam/core/grid_submap.h>
#include <submap_slam/core/packed_evidence.h>

#include <string>
#include <vector>

namespace submap_slam {

using GridSubmaps = std::vector<GridSubmap::Ptr>;

struct StampedPose {
  mrpt::Clock::time_point stamp;
  mrpt::math::TPose2D pose;  ///< T_w_robot, or T_odom_robot (m, rad)
};
using Trajectory = std::vector<StampedPose>;

enum class JoinStatus {
  kChained,         ///< frames from the chain of end poses, nothing optimised
  kConverged,       ///< a stopping rule was met
  kIterationLimit,  ///< stopped by the cap on iterations; usable
  kNothingToJoin,   ///< one submap, or no overlap at all; frames are those it was given
  kFailed           ///< no usable step was found; frames are those it was given
};
const char* toString(JoinStatus status);

/** A relation between two submap frames that a joiner used or refused. */
struct Constraint {
  uint32_t from = 0, to = 0;            ///< submap ids
  mrpt::poses::CPosePDFGaussian T_a_b;  ///< frame `to` seen from frame `from`
  bool inter = false;                   ///< inter-submap (loop closure); false: chain of consecutive submaps
  bool accepted = true;
  std::string reason;  ///< why it was refused or what it rests on

  /** The user said so, and it binds: certain if accepted, else not to be used whatever a joiner finds. */
  bool by_hand = false;
};

/** One step of an iterative joiner. */
struct JoinIteration {
  int level = 0;  ///< coarse-to-fine level, 0 = finest
  double cost = 0;
  double max_step_m = 0, max_step_rad = 0;
};

/** Submap frames in the global map frame and what came with finding them. */
struct JoinedMap {
  JoinStatus status = JoinStatus::kChained;
  std::string reason;

  /** T_w_s of each submap, in the order of the submaps; the first is fixed at the identity. */
  std::vector<mrpt::poses::CPosePDFGaussian> frames;

  /** T_s_node of every node of every submap, if a joiner moved nodes inside their submaps; empty: they are
   * where the submaps have them. */
  std::vector<std::vector<mrpt::math::TPose2D>> nodes;

  PackedEvidence map;  ///< global evidence in the global map frame
  double objective = 0;
  std::vector<JoinIteration> iterations;
  std::vector<Constraint> constraints;
};

/** Frames by composing the end poses, T_w_{k+1} = T_w_k ∘ T_k_end, with first-order covariance; the chain
 * constraints are listed. Submaps whose predecessor has no successor (a gap in the log) start again at the
 * predecessor's last pose. */
JoinedMap chainSubmaps(const GridSubmaps& submaps);

/** T_s_node of the nodes of submap k, where the joiners left them. Throws std::invalid_argument if there are
 * not as many as the submap has. */
std::vector<mrpt::math::TPose2D> nodePosesOf(const GridSubmaps& submaps, const JoinedMap& joined,
                                             std::size_t k);

/** The pose T_w_robot of every node of every submap, in log order. Throws std::invalid_argument if frames or
 * nodes are not as many as those of the submaps. */
Trajectory trajectoryOf(const GridSubmaps& submaps, const JoinedMap& joined);

/** The pose by odometry, T_odom_robot, of every frame that has one, in the order of the frames. */
Trajectory odometryOf(const std::vector<Frame>& frames);

/** Global map for given frames in closed form: M̂_j = Σ_i ω_ij L_i(p_ij) / Σ_i ω_ij², ω_ij = N_i(p_ij) /
 * N_M(m_j), N_M = Σ_i N_i (Wang, Zhao, Huang, "Grid-based Submap Joining", eq. 15), L_i and N_i bilinear.
 * Cells that no submap observed stay unknown.
 * @param resolution metres per cell of the result; ≤ 0: that of the finest submap, doubled until the
 * map has at most 20 million cells */
PackedEvidence fuseEvidence(const GridSubmaps& submaps,
                            const std::vector<mrpt::poses::CPosePDFGaussian>& frames, double resolution);

}  // namespace submap_slam
