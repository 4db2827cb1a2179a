#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "jacobian.h"
#include "lane_kernel.h"
#include "lattice.h"

namespace submap_slam::grid_joining {

/** Sums over tiles, for each submap and each pair of submaps that meet in one of them. */
class TileSums {
 public:
  explicit TileSums(std::size_t submaps) : rows_(submaps) {}

  std::size_t observations = 0, cells = 0;  ///< in the sums

  struct Own {
    std::size_t submap;
    OwnSums sums{};
  };
  struct Link {
    std::size_t i, k;  ///< i < k
    LinkSums sums{};
  };
  const std::vector<Own>& own() const { return own_; }
  const std::vector<Link>& links() const { return links_; }

  /** References are valid until the next call. */
  OwnSums& own(std::size_t submap);
  LinkSums& link(std::size_t i, std::size_t k);

 private:
  /** Where the sums of a submap and of its pairs (submap, k) are; pairs are few, so they are searched. */
  struct Row {
    int own = -1;
    std::vector<std::pair<std::size_t, std::size_t>> links;  ///< k and the index in links_
  };
  std::vector<Row> rows_;
  std::vector<Own> own_;
  std::vector<Link> links_;
};

/** Cost and normal equations of tiles, J as in LaneKernel. The working memory is kept from tile to tile. */
template <class Scalar>
class TileKernel {
 public:
  TileKernel(JacobianKind jacobian, const LaneKernel<Scalar>& loops) : jacobian_(jacobian), loops_(loops) {}

  /** Adds what the tile shows to the sums. */
  void add(const Tile& tile, const PlacedLevels& placed, TileSums& sums);

 private:
  bool allMarked() const;
  void listPoints();
  const Row<Scalar>& shareOf(const MemberRows<Scalar>& member);

  JacobianKind jacobian_;
  const LaneKernel<Scalar>& loops_;

  std::vector<TileView<Scalar>> views_;
  std::vector<MemberRows<Scalar>> members_;  ///< of this tile; there may be more, from another one
  std::vector<bool> moves_;                  ///< whether any row J of the member is not zero

  std::array<uint8_t, kTilePoints> marked_{};
  PointList<Scalar> points_{};
  MapRows<Scalar> map_{};
  alignas(64) Row<Scalar> share_{};
};

extern template class TileKernel<float>;
extern template class TileKernel<double>;

}  // namespace submap_slam::grid_joining
