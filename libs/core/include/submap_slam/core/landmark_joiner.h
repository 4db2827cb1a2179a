#pragma once

#include <submap_slam/core/joined_landmarks.h>
#include <submap_slam/core/joiner.h>
#include <submap_slam/core/progress.h>

#include <memory>

namespace submap_slam {

/** A joining that goes on as submaps come. After an exception it is of no use any more. */
class IncrementalLandmarkJoin {
 public:
  virtual ~IncrementalLandmarkJoin() = default;

  /** Joins what there is by now. Parameters and result are those of LandmarkJoiner::join, to the same bits,
   * but what calls before found need not be found again.
   * @param submaps those of the call before, and any number behind them */
  virtual JoinedLandmarks join(const LandmarkSubmaps& submaps, const ProgressCallback& progress) = 0;
};

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

  /** Begins a joining to which submaps can be added; it uses this joiner, which must outlive it. Unless a
   * joiner knows better, everything is joined anew each time. */
  virtual std::unique_ptr<IncrementalLandmarkJoin> incremental() const;
};

}  // namespace submap_slam
