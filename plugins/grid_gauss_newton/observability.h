#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "levenberg_marquardt.h"

namespace submap_slam::grid_joining {

/** A direction of a submap frame, seen from the first one of its group, that the evidence leaves open: by
 * itself it would not hold the frame to half a cell, or turned by so little that 5 m away it would not move
 * by more. Such a direction is where the chain puts it. */
struct OpenDirection {
  std::size_t submap = 0;
  bool heading = false;  ///< of the frame, else of its position
  double direction = 0;  ///< of the position, in the global map frame (rad, between −π/2 and π/2)
  double sigma = 0;      ///< standard deviation with the chain (m or rad)
};

/** At most one direction of the position and the heading of every submap.
 * @param covariances marginal covariances of the frames, see marginalCovariances */
std::vector<OpenDirection> openDirections(const Evaluation& evaluation, double evidence_variance,
                                          const std::vector<Eigen::Matrix3d>& covariances,
                                          double cell_size_m);

/** The directions in words, largest first, at most three of them; empty if there are none.
 * @param ids of the submaps */
std::string describeOpen(const std::vector<OpenDirection>& directions, const std::vector<uint32_t>& ids);

/** Groups of submaps that nothing links in words; empty if there is one only.
 * @param groups first submap of its group for every submap, see groupsOf */
std::string describeGroups(const std::vector<std::size_t>& groups, const std::vector<uint32_t>& ids);

}  // namespace submap_slam::grid_joining
