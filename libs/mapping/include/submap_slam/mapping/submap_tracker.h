#pragma once

#include <submap_slam/core/grid_submap.h>
#include <submap_slam/mapping/laser_points.h>
#include <submap_slam/mapping/local_path.h>

#include <optional>

namespace submap_slam {

/** Follows the robot through the frames of one submap: matches each scan to the map that the scans before it
 * made. What local mappers differ in; the rest of their work is GridMapper's. */
class SubmapTracker {
 public:
  virtual ~SubmapTracker() = default;

  /** Takes the next frame. @param increment T_previous_now by odometry; empty: constant velocity is assumed
   */
  virtual void step(const LaserPoints& scan, const std::optional<mrpt::math::TPose2D>& increment) = 0;

  /** That of the best hypothesis; its frame is the tracker's own. */
  virtual const LocalPath& path() const = 0;

  /** A node of the path after its scan, which is not empty, was matched once more, to the map as it is now.
   */
  virtual PathNode rematched(const PathNode& node, const LaserPoints& scan) const = 0;

  /** True while it is open which of several hypotheses is right. */
  virtual bool undecided() const = 0;

  /** What the tracker itself counted; the rest is left 0. */
  virtual SubmapStatistics statistics() const = 0;
};

}  // namespace submap_slam
