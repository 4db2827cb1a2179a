#pragma once

#include <cmath>
#include <cstddef>

namespace submap_slam {

/** Length of the way from one to the next (m).
 * @param nodes a list of what has a planar `pose`, such as a Trajectory or the nodes of a submap */
template <class Nodes>
double pathLength(const Nodes& nodes) {
  double length = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i)
    length += std::hypot(nodes[i].pose.x - nodes[i - 1].pose.x, nodes[i].pose.y - nodes[i - 1].pose.y);
  return length;
}

}  // namespace submap_slam
