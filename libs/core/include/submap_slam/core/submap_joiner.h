#pragma once

#include <submap_slam/core/joined_map.h>
#include <submap_slam/core/joiner.h>
#include <submap_slam/core/progress.h>

#include <memory>

namespace submap_slam {

/** A joining that goes on as submaps come. After an exception it is of no use any more. */
class IncrementalJoin {
 public:
  virtual ~IncrementalJoin() = default;

  /** Joins what there is by now. Parameters and result are those of SubmapJoiner::join, to the same bits, but
   * what calls before found need not be found again.
   * @param submaps the same objects as in the call before, and any number behind them
   * @param initial constraints by hand may come with the submaps that they are of; otherwise they are always
   * the same */
  virtual JoinedMap join(const GridSubmaps& submaps, const JoinedMap& initial,
                         const ProgressCallback& progress) = 0;
};

/** Finds the frames of grid submaps (and the map) that fit together best. */
class SubmapJoiner : public Joiner {
  DEFINE_VIRTUAL_MRPT_OBJECT(SubmapJoiner)

 public:
  /** Joins.
   * @param submaps  in log order, at least one
   * @param initial  frames to start from, one for each submap (from the chain or the joiner before), with the
   * constraints so far; those by hand bind
   * @param progress may be empty; false from it ends the iteration early with the best frames so far. A
   * joiner that iterates shows its frames (ProgressCallback::showFrames), so that one can look on
   * @return frames with the first one fixed, and the nodes of `initial` unless the joiner places them anew; a
   * status instead of an exception for every numerical outcome.
   * The global map may be left empty: the caller then fuses it by eq. (15). The result must not depend on the
   * number of threads. */
  virtual JoinedMap join(const GridSubmaps& submaps, const JoinedMap& initial,
                         const ProgressCallback& progress) const = 0;

  /** Begins a joining to which submaps can be added; it uses this joiner, which must outlive it. Unless a
   * joiner knows better, everything is joined anew each time. */
  virtual std::unique_ptr<IncrementalJoin> incremental() const;
};

}  // namespace submap_slam
