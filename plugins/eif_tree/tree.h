#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

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
 *
 * Parts of 1, 2, 4, … submaps are kept as the digits of a binary counter: a submap more joins parts of equal
 * size only, and at the end those that are left are joined, the smallest first. So the tree is updated, not
 * rebuilt, when submaps come, and its result does not depend on when they came.
 */
class JoiningTree {
 public:
  explicit JoiningTree(const TreeOptions& options) : options_(options) {}

  /** Joins all submaps of a problem; its first ones are those of the call before.
   * @param ids of the landmarks, ascending; landmarks of the call before keep theirs
   * @param progress called with the share of the work done; false ends it (the rest is only moved)
   * @return estimate in the frame of the first submap; empty if an information matrix was not positive
   * definite. After that, or if it was stopped, the next call begins anew. */
  std::optional<TreeResult> join(const JointProblem& problem, const std::vector<uint32_t>& ids,
                                 const std::function<bool(double)>& progress);

 private:
  /** Estimate of the submaps [first, last) in the frame of the first one's start. */
  struct Part {
    std::size_t first = 0, last = 0;
    JointState state;
    std::vector<uint32_t> landmarks;  ///< ids of the state's, ascending

    std::size_t size() const { return last - first; }
  };
  class Work;

  TreeOptions options_;
  std::vector<Part> parts_;  // one behind the other, sizes are descending powers of two
};

}  // namespace submap_slam::landmark_joining
