#pragma once

#include <submap_slam/core/grid_submap.h>
#include <submap_slam/mapping/grid_mapper.h>
#include <submap_slam/mapping/laser_points.h>

#include <limits>

namespace submap_slam {

/** The beams of the scans that a node keeps, as the mapper takes them. */
inline LaserPoints pointsOf(const SubmapScans& scans, const GridMapperParams& mapper) {
  Frame frame;
  frame.scans = scans;
  return toLaserPoints(frame, mapper.max_range > 0 ? mapper.max_range : std::numeric_limits<double>::max());
}

}  // namespace submap_slam
