#pragma once

#include <submap_slam/core/frame.h>
#include <submap_slam/core/grid_submap.h>

#include <vector>

namespace submap_slam {

/** Frames of the log from which submaps are built independently of all others. */
struct Stretch {
  std::size_t index = 0;  ///< position in the sequence of stretches, from 0
  std::size_t warm_up =
      0;  ///< this many frames at the front belong to the previous stretch and only prepare the matching map
  std::vector<Frame>
      frames;         ///< warm-up frames, own frames, and (unless `last`) the first frame of the next stretch
  bool last = false;  ///< nothing follows in the log

  /** Number of frames that belong to this stretch. */
  std::size_t ownFrames() const { return frames.size() - warm_up - (last ? 0 : 1); }
};

/** Builds the submaps of a stretch. Implementations hold no state between stretches, so that stretches can be
 * mapped in any order and by any number of threads with the same result. */
class LocalMapper {
 public:
  virtual ~LocalMapper() = default;

  /** One submap, or more where a decision rule of the filter closed one before the end of the stretch. Their
   * ids are left 0. Deterministic: depends on the stretch and the parameters alone. Thread-safe. */
  virtual std::vector<GridSubmap::Ptr> map(const Stretch& stretch) const = 0;
};

}  // namespace submap_slam
