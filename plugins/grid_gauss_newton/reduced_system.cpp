#include "reduced_system.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "tile_kernel.h"

namespace submap_slam::grid_joining {
namespace {

/** More blocks than any machine has threads, few enough that adding them up costs nothing. */
constexpr std::size_t kBlocks = 32;

/** Calls sum(block, begin, end) for each block of tiles [begin, end). */
template <class Sum>
std::size_t forBlocksOfTiles(const std::vector<Tile>& tiles, Sum sum) {
  const std::size_t blocks = std::min(kBlocks, tiles.size());
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    sum(block, block * tiles.size() / blocks, (block + 1) * tiles.size() / blocks);
  });
  return blocks;
}

/** From motions in the global map frame to what the rows J of LaneKernel are about. */
Eigen::Matrix3d globalToCells(const PlacedLevel& placed, double heading) {
  const double per_metre = 1 / placed.level().resolution();
  return Eigen::Vector3d(-per_metre, -per_metre, 1).asDiagonal() * globalToLocalMotion(heading);
}

Eigen::Matrix3d blockOf(const OwnSums& sums) {
  const auto at = [&sums](std::size_t k) { return total(sums.block[k]); };
  Eigen::Matrix3d block;
  block << at(0), at(1), at(2), at(1), at(3), at(4), at(2), at(4), at(5);
  return block;
}

Eigen::Matrix3d blockOf(const LinkSums& sums) {
  Eigen::Matrix3d block;
  for (std::size_t k = 0; k < sums.size(); ++k)
    block(static_cast<Eigen::Index>(k / 3), static_cast<Eigen::Index>(k % 3)) = -total(sums[k]);
  return block;
}

Eigen::Vector3d gradientOf(const OwnSums& sums) {
  return {total(sums.gradient[0]), total(sums.gradient[1]), total(sums.gradient[2])};
}

void addTo(ReducedSystem& reduced, const TileSums& sums, const std::vector<Eigen::Matrix3d>& motions) {
  reduced.observations += sums.observations;
  reduced.cells += sums.cells;
  const auto addBlock = [&](std::size_t i, std::size_t k, const Eigen::Matrix3d& block) {
    if (!block.isZero(0)) reduced.system.addBlock(i, k, motions[i].transpose() * block * motions[k]);
  };
  for (const auto& [i, own] : sums.own()) {
    reduced.cost += total(own.cost);
    reduced.energy += total(own.energy);
    reduced.system.gradient[i] += motions[i].transpose() * gradientOf(own);
    addBlock(i, i, blockOf(own));
  }
  for (const auto& [i, k, link] : sums.links()) addBlock(i, k, blockOf(link));
}

}  // namespace

template <class Scalar>
ReducedSystem reduce(const PlacedLevels& placed, const Frames& frames, JacobianKind jacobian,
                     InstructionSet instructions) {
  std::vector<TileSums> sums(kBlocks, TileSums(frames.size()));
  tbb::enumerable_thread_specific<TileKernel<Scalar>> kernels(jacobian, laneKernel<Scalar>(instructions));
  const auto sum_tiles = [&](std::size_t block, std::size_t begin, std::size_t end) {
    TileKernel<Scalar>& kernel = kernels.local();
    for (std::size_t t = begin; t < end; ++t) kernel.add(placed.tiles[t], placed, sums[block]);
  };
  const std::size_t blocks = forBlocksOfTiles(placed.tiles, sum_tiles);
  std::vector<Eigen::Matrix3d> motions;
  for (std::size_t i = 0; i < frames.size(); ++i)
    motions.push_back(globalToCells(placed.submaps[i], frames[i].phi));
  ReducedSystem reduced(frames.size());
  for (std::size_t block = 0; block < blocks; ++block) addTo(reduced, sums[block], motions);
  return reduced;
}

template ReducedSystem reduce<float>(const PlacedLevels&, const Frames&, JacobianKind, InstructionSet);
template ReducedSystem reduce<double>(const PlacedLevels&, const Frames&, JacobianKind, InstructionSet);

double overlapWeight(const PlacedLevels& placed, int stride) {
  const auto weightAt = [&placed](const Tile& tile, int a, int b) {
    double ww = 0, w4 = 0;
    for (std::size_t k = tile.first_member; k < tile.first_member + tile.members; ++k) {
      const PlacedLevel& submap = placed.submaps[placed.members[k].submap];
      const double hits = submap.level().hitsAt(submap.columnOf(a, b), submap.rowOf(a, b));
      ww += hits * hits, w4 += hits * hits * hits * hits;
    }
    return ww > 0 ? 0.5 * (ww - w4 / ww) : 0;
  };
  std::vector<double> sums(kBlocks, 0);
  forBlocksOfTiles(placed.tiles, [&](std::size_t block, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (int b = 0; b < kTile; b += stride)
        for (int a = 0; a < kTile; a += stride)
          sums[block] += weightAt(placed.tiles[t], placed.tiles[t].a + a, placed.tiles[t].b + b);
  });
  double sum = 0;
  for (const double s : sums) sum += s;
  return sum * stride * stride;
}

}  // namespace submap_slam::grid_joining
