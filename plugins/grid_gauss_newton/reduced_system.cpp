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

/** The sums of a block of tiles, with the pairs' blocks found by index. */
class TileSums {
 public:
  explicit TileSums(std::size_t frames) : total_(frames), index_(frames * frames, -1) {}

  template <class Scalar>
  void add(const TileKernel<Scalar>& kernel, const Tile& tile);

  ReducedSystem total() const;

 private:
  Eigen::Matrix3d& block(std::size_t i, std::size_t k);

  ReducedSystem total_;  // without the pairs' blocks
  std::vector<int> index_;
  std::vector<std::pair<PosePair, Eigen::Matrix3d>> blocks_;
};

Eigen::Matrix3d& TileSums::block(std::size_t i, std::size_t k) {
  int& index = index_[i * total_.system.frames() + k];
  if (index < 0) {
    index = static_cast<int>(blocks_.size());
    blocks_.emplace_back(PosePair{i, k}, Eigen::Matrix3d::Zero());
  }
  return blocks_[static_cast<std::size_t>(index)].second;
}

template <class Scalar>
void TileSums::add(const TileKernel<Scalar>& kernel, const Tile& tile) {
  total_.cost += kernel.cost();
  total_.energy += kernel.energy();
  total_.observations += kernel.observations();
  total_.cells += kernel.cells();
  for (std::size_t a = 0; a < tile.members.size(); ++a) {
    if (!kernel.contributes(a)) continue;
    const std::size_t i = tile.members[a].submap;
    total_.system.gradient[i] += kernel.gradient(a);
    for (std::size_t b = a; b < tile.members.size(); ++b)
      if (kernel.contributes(b)) block(i, tile.members[b].submap) += kernel.block(a, b);
  }
}

ReducedSystem TileSums::total() const {
  ReducedSystem total = total_;
  for (const auto& [pair, block] : blocks_) total.system.addBlock(pair.first, pair.second, block);
  return total;
}

/** From motions along the submaps' own axes to motions in the global map frame. */
PoseSystem toGlobal(const PoseSystem& local, const Frames& frames) {
  PoseSystem global(frames.size());
  std::vector<Eigen::Matrix3d> motions;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    motions.push_back(globalToLocalMotion(frames[i].phi));
    global.gradient[i] = motions[i].transpose() * local.gradient[i];
  }
  for (const auto& [pair, block] : local.blocks)
    if (!block.isZero(0))
      global.addBlock(pair.first, pair.second,
                      motions[pair.first].transpose() * block * motions[pair.second]);
  return global;
}

}  // namespace

void ReducedSystem::add(const ReducedSystem& other) {
  cost += other.cost;
  energy += other.energy;
  observations += other.observations;
  cells += other.cells;
  system.add(other.system, 1);
}

template <class Scalar>
ReducedSystem reduce(const PlacedLevels& placed, const Frames& frames, JacobianKind jacobian) {
  std::vector<TileSums> sums(kBlocks, TileSums(frames.size()));
  tbb::enumerable_thread_specific<TileKernel<Scalar>> kernels(jacobian);  // working memory only
  const auto sum_tiles = [&](std::size_t block, std::size_t begin, std::size_t end) {
    TileKernel<Scalar>& kernel = kernels.local();
    for (std::size_t t = begin; t < end; ++t)
      if (kernel.evaluate(placed.tiles[t], placed)) sums[block].add(kernel, placed.tiles[t]);
  };
  const std::size_t blocks = forBlocksOfTiles(placed.tiles, sum_tiles);
  ReducedSystem total(frames.size());
  for (std::size_t block = 0; block < blocks; ++block) total.add(sums[block].total());
  total.system = toGlobal(total.system, frames);
  return total;
}

template ReducedSystem reduce<float>(const PlacedLevels&, const Frames&, JacobianKind);
template ReducedSystem reduce<double>(const PlacedLevels&, const Frames&, JacobianKind);

double overlapWeight(const PlacedLevels& placed, int stride) {
  const auto weightAt = [&placed](const Tile& tile, int a, int b) {
    double ww = 0, w4 = 0;
    for (const TileMember& member : tile.members) {
      const PlacedLevel& submap = placed.submaps[member.submap];
      const double hits = submap.level().sample(submap.columnOf(a, b), submap.rowOf(a, b)).hits;
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
