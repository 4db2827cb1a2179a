#pragma once

#include <submap_slam/core/joined_landmarks.h>
#include <submap_slam/core/joiner.h>
#include <submap_slam/core/progress.h>

namespace submap_slam {

/** Finds the landmarks and the end poses of a sequence of landmark submaps that fit together best. */
class LandmarkJoiner : public Joiner {
  DEFINE_VIRTUAL_MRPT_OBJECT(LandmarkJoiner)

 public:
  /** Joins.
   * @param submaps  in the order of the path, at least one, each of which requireUsable() accepts
   * @param progress may be empty; false from it ends the work early with the best estimate so far
   * @return one frame for each submap and one for the end of the last; a status instead of an exception for
   * every numerical outcome. The result must not depend on the number of threads. */
  virtual JoinedLandmarks join(const LandmarkSubmaps& submaps, const ProgressCallback& progress) const = 0;
};

}  // namespace submap_slam
