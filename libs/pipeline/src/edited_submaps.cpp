#include <submap_slam/pipeline/edited_submaps.h>

#include <algorithm>

namespace submap_slam {

void EditedSubmaps::add(const GridSubmaps& submaps) {
  const GridSubmaps masked = maskSubmaps(submaps, edits_);
  all_.insert(all_.end(), submaps.begin(), submaps.end());
  shown_.insert(shown_.end(), masked.begin(), masked.end());
}

std::vector<Constraint> EditedSubmaps::byHand() const {
  std::vector<Constraint> constraints = constraintsOf(edits_, all_);
  const auto isHere = [this](uint32_t id) {
    return std::any_of(all_.begin(), all_.end(), [id](const auto& submap) { return submap->id == id; });
  };
  const auto isElsewhere = [&](const Constraint& c) { return !isHere(c.from) || !isHere(c.to); };
  constraints.erase(std::remove_if(constraints.begin(), constraints.end(), isElsewhere), constraints.end());
  return constraints;
}

}  // namespace submap_slam
