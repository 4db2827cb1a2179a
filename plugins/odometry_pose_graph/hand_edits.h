#pragma once

#include <submap_slam/core/joined_map.h>

#include <set>
#include <utility>
#include <vector>

#include "frame_graph.h"

namespace submap_slam::pose_graph {

/** What the user decided; it binds. */
struct HandEdits {
  std::vector<Link> links;                                ///< certain
  std::set<std::pair<std::size_t, std::size_t>> refused;  ///< frames, the newer one first

  bool refuses(std::size_t newer, std::size_t older) const { return refused.count({newer, older}) > 0; }
};

/** Those among the constraints that are by hand. The submaps say which frame an id means; constraints of
 * others do not count. */
HandEdits handEditsOf(const std::vector<Constraint>& constraints, const GridSubmaps& submaps);

}  // namespace submap_slam::pose_graph
