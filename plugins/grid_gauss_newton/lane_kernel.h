#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lattice.h"

namespace submap_slam::grid_joining {

/** Sums run over that many lanes on every machine, whatever it can do at once: the same bits everywhere. */
constexpr std::size_t kLanes = 16;

/** Lattice points of a tile, and how many values a row of them has room for: not a power of two, or the same
 * point of all rows would fall into the same lines of the cache. */
constexpr std::size_t kTilePoints = kTile * kTile, kRowSize = kTilePoints + kLanes;

/** One value for each listed lattice point. */
template <class Scalar>
using Row = std::array<Scalar, kRowSize>;

/** The listed lattice points of a tile, counted from its first one. */
template <class Scalar>
struct alignas(64) PointList {
  Row<Scalar> a, b;  ///< any points of the tile fill up the last lanes
  std::size_t count = 0;

  /** With the points that fill up the last lanes; they see nothing. */
  std::size_t padded() const { return (count + kLanes - 1) / kLanes * kLanes; }
};

/** How to look a submap up in a tile. Index coordinates of lattice point (a, b) are u = u0 + u_a a − v_a b
 * and v = v0 + v_a a + u_a b, counted from a cell on a block border so that they are small and positive: a
 * float holds their fractions, and a cast rounds down. */
template <class Scalar>
struct TileView {
  TileView(const Tile& tile, const PlacedLevel& submap);

  Scalar u0, v0, u_a, v_a;
  Scalar x0, y0;             ///< the cell that u and v are counted from, in cells from the submap's frame
  EvidenceBlockTable table;  ///< at that cell
};

/** What one submap shows at the listed points, lengths in cells. */
template <class Scalar>
struct alignas(64) MemberRows {
  Row<Scalar> log_odds, hits;
  Row<Scalar> log_odds_u, log_odds_v, hits_u, hits_v;  ///< gradients
  Row<Scalar> x, y;                                    ///< point in the submap's frame
  std::array<Row<Scalar>, 3> weighted;                 ///< w J / √W
};

/** What all members of a tile say together at the listed points. */
template <class Scalar>
struct alignas(64) MapRows {
  Row<Scalar> valid;         ///< 1 where two or more submaps see something, else 0
  Row<Scalar> joint_value;   ///< m
  Row<Scalar> inverse_root;  ///< 1/√W
  std::size_t cells = 0;     ///< valid ones
  std::size_t observations = 0;
};

/** A sum over points in its last four partial sums, which are added up when all tiles are done. */
using PartialSum = std::array<double, 4>;
inline double total(const PartialSum& sum) { return (sum[0] + sum[1]) + (sum[2] + sum[3]); }

/** Σ (1 − w²/W) JᵀJ (upper triangle, row by row), Σ Jᵀ(L − w m), Σ (L − w m)² and Σ L² of one submap. */
struct OwnSums {
  std::array<PartialSum, 6> block{};
  std::array<PartialSum, 3> gradient{};
  PartialSum cost{}, energy{};
};

/** Σ w_i w_k / W · J_iᵀ J_k of two submaps, row by row. */
using LinkSums = std::array<PartialSum, 9>;

/** The loops over lattice points. J is that of localJacobian with all lengths in cells and without the sign
 * of the translation: (g_u, g_v, g_u y − g_v x). */
template <class Scalar>
struct LaneKernel {
  /** Sets marked[kTile b + a] where the submap shows a surface. */
  void (*mark)(const TileView<Scalar>& view, std::array<uint8_t, kTilePoints>& marked);

  /** Looks the submap up at the listed points. */
  void (*sample)(const TileView<Scalar>& view, const PointList<Scalar>& points, MemberRows<Scalar>& member);

  /** Joint value of the members. */
  void (*fuse)(const MemberRows<Scalar>* members, std::size_t count, std::size_t points,
               MapRows<Scalar>& map);

  /** L/N */
  void (*divide)(const MemberRows<Scalar>& member, std::size_t points, Row<Scalar>& per_hit);

  /** Adds the member's own sums, with g = ∇L − share ∇N, and leaves w J / √W in it; false if all J are zero.
   */
  bool (*linearise)(const Row<Scalar>& share, const MapRows<Scalar>& map, std::size_t points,
                    MemberRows<Scalar>& member, OwnSums& sums);

  /** Adds what links two members. */
  void (*link)(const MemberRows<Scalar>& first, const MemberRows<Scalar>& second, std::size_t points,
               LinkSums& sums);
};

/** Instruction sets that the loops are compiled for; the result has the same bits with all of them. */
enum class InstructionSet {
  kBaseline,  ///< every machine
  kAvx2,
  kAvx512  ///< F, BW, DQ and VL
};
bool isSupported(InstructionSet set);
InstructionSet bestInstructionSet();

template <class Scalar>
const LaneKernel<Scalar>& laneKernel(InstructionSet set);

extern template struct TileView<float>;
extern template struct TileView<double>;
extern template const LaneKernel<float>& laneKernel<float>(InstructionSet);
extern template const LaneKernel<double>& laneKernel<double>(InstructionSet);

}  // namespace submap_slam::grid_joining
