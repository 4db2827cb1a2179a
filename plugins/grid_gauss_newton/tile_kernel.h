#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "jacobian.h"
#include "lattice.h"

namespace submap_slam::grid_joining {

/** Cost and normal equations of one tile, in the submaps' own axes (localJacobian). Plain loops over arrays,
 * one array per quantity, so that the compiler can work on several cells at once; the working memory is kept
 * from tile to tile. */
template <class Scalar>
class TileKernel {
 public:
  explicit TileKernel(JacobianKind jacobian) : jacobian_(jacobian) {}

  /** Sums up the tile; false if nothing in it counts. */
  bool evaluate(const Tile& tile, const PlacedLevels& placed);

  double cost() const { return cost_; }
  double energy() const { return energy_; }
  std::size_t observations() const { return observations_; }
  std::size_t cells() const { return cells_; }

  /** J^T(L − w m) of a member of the tile. */
  Eigen::Vector3d gradient(std::size_t member) const;

  /** J_iᵀ(δ_ik − w_i w_k/W) J_k of two members, i ≤ k. */
  Eigen::Matrix3d block(std::size_t i, std::size_t k) const;

  /** Whether any row J_i of the member is not zero. */
  bool contributes(std::size_t member) const { return contributes_[member]; }

 private:
  static constexpr int kCells = kTile * kTile;

  /** Not a power of two, or the same cell of all arrays would fall into the same lines of the cache. */
  static constexpr int kPaddedCells = kCells + 16;
  using Row = std::array<Scalar, kPaddedCells>;
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

  /** What one submap shows at the listed cells. */
  struct Member {
    Row log_odds, hits;
    std::array<Row, 2> log_odds_gradient, hits_gradient;  ///< per metre
    std::array<Row, 2> point;                             ///< in the local map frame (m)
  };

  void listCells(const Tile& tile, const PlacedLevels& placed);
  void markSurface(const Tile& tile, const PlacedLevel& submap);
  void makeRoom(std::size_t members);
  void sample(const Tile& tile, const PlacedLevel& submap, Member& member) const;
  void reduceMap();
  void linearise(std::size_t i);

  JacobianKind jacobian_;
  std::size_t count_ = 0;  ///< members of this tile; there is room for more
  std::vector<Member> members_;
  std::vector<bool> contributes_;

  std::array<uint8_t, kCells> marked_{};
  std::array<uint8_t, kCells> a_{}, b_{};  ///< lattice points of the listed cells, from the tile's first one
  Eigen::Index listed_ = 0;                ///< how many

  Row valid_, joint_value_, inverse_root_;  ///< 1 or 0; m; 1/√W
  Matrix residual_;                         ///< L − w m: cells × members
  Matrix jacobian_rows_, weighted_rows_;    ///< J and w J / √W: cells × 3 members
  Matrix linked_;                           ///< Σ w_i w_k / W · J_iᵀ J_k, lower triangle
  double cost_ = 0, energy_ = 0;
  std::size_t observations_ = 0, cells_ = 0;
};

extern template class TileKernel<float>;
extern template class TileKernel<double>;

}  // namespace submap_slam::grid_joining
