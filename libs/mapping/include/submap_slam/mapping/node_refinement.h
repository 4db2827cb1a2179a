#pragma once

#include <submap_slam/core/joined_map.h>
#include <submap_slam/core/parameters.h>
#include <submap_slam/mapping/grid_mapper.h>

#include <functional>

namespace submap_slam {

/** Refinement of the scan poses inside submaps after they were joined. */
struct NodeRefinementParams {
  int rounds = 0;           ///< times that poses are refined and the submaps joined again; 0: never
  int sweeps = 5;           ///< times in a round that every scan is matched and the map of scans made anew
  double sigma_xy = 0.05;   ///< m, how far a sweep may move a pose
  double sigma_phi = 0.02;  ///< rad, how far a sweep may turn a pose
};

/** Adds the section [node_refinement]. */
void describe(ParameterTable& table, NodeRefinementParams& params);

/** Submaps whose poses and evidence changed, and where they are now. */
struct RefinedSubmaps {
  GridSubmaps submaps;  ///< new ones, unloaded
  JoinedMap joined;     ///< frames and constraints of the new submaps, to join them from; no map
  double mean_move = 0, max_move = 0;  ///< of the key nodes in the global map frame (m)
};

/** Matches the scan of every key node to the scans of all submaps, placed as they were joined, and makes the
 * submaps again from the new poses.
 *
 * A sweep alternates between the map, surfels of all key scans at their poses T_w_n, and the poses: each scan
 * is matched to that map with its pose as prior, independently of the others. Nodes that keep no scan are
 * carried along with the key nodes before and after them. A submap's frame stays the pose of its first node
 * and the map's frame that of the first submap's, so both may move; end poses and constraints follow. What
 * this changes is the drift inside submaps, which no joining of rigid submaps can take out.
 *
 * @param store called with each new submap, in order, as soon as it is made; may store its bulk away
 * Deterministic for any number of threads. Throws std::invalid_argument if frames or nodes do not fit the
 * submaps. */
RefinedSubmaps refineNodes(const GridSubmaps& submaps, const JoinedMap& joined,
                           const GridMapperParams& mapper, const NodeRefinementParams& params,
                           const std::function<void(GridSubmap&)>& store = {});

}  // namespace submap_slam
