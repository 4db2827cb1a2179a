#include "tile_kernel.h"

#include <algorithm>

namespace submap_slam::grid_joining {

OwnSums& TileSums::own(std::size_t submap) {
  int& index = rows_[submap].own;
  if (index < 0) {
    index = static_cast<int>(own_.size());
    own_.push_back({submap});
  }
  return own_[static_cast<std::size_t>(index)].sums;
}

LinkSums& TileSums::link(std::size_t i, std::size_t k) {
  auto& links = rows_[i].links;
  const auto known =
      std::find_if(links.begin(), links.end(), [k](const auto& link) { return link.first == k; });
  if (known != links.end()) return links_[known->second].sums;
  links.emplace_back(k, links_.size());
  links_.push_back({i, k});
  return links_.back().sums;
}

template <class Scalar>
void TileKernel<Scalar>::add(const Tile& tile, const PlacedLevels& placed, TileSums& sums) {
  if (!tile.surface) return;
  const TileMember* const seen_by = &placed.members[tile.first_member];
  const std::size_t count = tile.members;
  views_.clear();
  for (std::size_t i = 0; i < count; ++i) views_.emplace_back(tile, placed.submaps[seen_by[i].submap]);
  marked_.fill(0);
  for (std::size_t i = 0; i < count && !allMarked(); ++i)
    if (seen_by[i].surface) loops_.mark(views_[i], marked_);
  listPoints();
  if (points_.count == 0) return;

  const std::size_t padded = points_.padded();
  if (members_.size() < count) members_.resize(count), moves_.resize(count);
  for (std::size_t i = 0; i < count; ++i) loops_.sample(views_[i], points_, members_[i]);
  loops_.fuse(members_.data(), count, padded, map_);
  if (map_.cells == 0) return;
  sums.cells += map_.cells;
  sums.observations += map_.observations;
  for (std::size_t i = 0; i < count; ++i)
    moves_[i] =
        loops_.linearise(shareOf(members_[i]), map_, padded, members_[i], sums.own(seen_by[i].submap));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = i + 1; moves_[i] && k < count; ++k)
      if (moves_[k])
        loops_.link(members_[i], members_[k], padded, sums.link(seen_by[i].submap, seen_by[k].submap));
}

template <class Scalar>
bool TileKernel<Scalar>::allMarked() const {
  return std::find(marked_.begin(), marked_.end(), 0) == marked_.end();
}

template <class Scalar>
void TileKernel<Scalar>::listPoints() {
  std::size_t n = 0;
  for (std::size_t k = 0; k < kTilePoints; ++k) {
    const std::size_t column = k % kTile, row = k / kTile;
    points_.a[n] = static_cast<Scalar>(column);
    points_.b[n] = static_cast<Scalar>(row);
    n += marked_[k];
  }
  points_.count = n;
  for (; n < points_.padded(); ++n) points_.a[n] = points_.b[n] = 0;
}

/** What ∇N is multiplied with before it is taken off ∇L. */
template <class Scalar>
const Row<Scalar>& TileKernel<Scalar>::shareOf(const MemberRows<Scalar>& member) {
  if (jacobian_ == JacobianKind::kVariableProjection) return map_.joint_value;
  if (jacobian_ == JacobianKind::kSurface) loops_.divide(member, points_.padded(), share_);
  return share_;  // zero for the published form
}

template class TileKernel<float>;
template class TileKernel<double>;

}  // namespace submap_slam::grid_joining
