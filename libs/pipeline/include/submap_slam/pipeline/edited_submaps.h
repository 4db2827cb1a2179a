#pragma once

#include <submap_slam/core/edits.h>

#include <vector>

namespace submap_slam {

/** Submaps, and what the user changes about joining them. */
class EditedSubmaps {
 public:
  /** @param edits must outlive this; whether they fit is for checkEdits to say */
  explicit EditedSubmaps(const Edits& edits) : edits_(edits) {}

  /** Puts more submaps behind those that are here. */
  void add(const GridSubmaps& submaps);

  const Edits& edits() const { return edits_; }
  const GridSubmaps& all() const { return all_; }

  /** What joiners get: without what is masked. The objects stay the same when others are added. */
  const GridSubmaps& shown() const { return shown_; }

  /** Constraints from the user, those left out that speak of submaps which are not here. */
  std::vector<Constraint> byHand() const;

 private:
  const Edits& edits_;
  GridSubmaps all_, shown_;
};

}  // namespace submap_slam
