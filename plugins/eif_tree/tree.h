#pragma once

#include <functional>
#include <optional>

#include "observation.h"

namespace submap_slam::landmark_joining {

struct TreeOptions {
  int steps_per_join = 1;   ///< Gauss-Newton steps after each join, relinearised
  bool refine_root = true;  ///< false: leave out those of the last join, because others follow
};

struct TreeResult {
  JointState state;
  bool stopped = false;  ///< some parts are only moved
};

/** Joins neighbouring submaps two by two, the results again, until one is left (the binary tree of Combined
 * SLAM). The frame of the second part of each join is the end pose of the first: its estimate is moved there,
 * landmarks of both parts become one, and the submaps of both parts are joined by the information form
 * (13)(16). Nothing is marginalised.
 * @param progress called with the share of the work done; false ends it (the rest is only moved)
 * @return estimate in the frame of the first submap; empty if an information matrix was not positive definite
 */
std::optional<TreeResult> joinTree(const JointProblem& problem, const TreeOptions& options,
                                   const std::function<bool(double)>& progress);

}  // namespace submap_slam::landmark_joining
