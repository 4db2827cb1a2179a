#include "overlap.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

namespace submap_slam {
namespace {

using Frames = std::vector<mrpt::poses::CPosePDFGaussian>;

/** A cell of the global lattice, as one bit in a block of 8 × 8. */
struct LatticeCell {
  uint64_t block, bit;

  LatticeCell(double x, double y, double resolution) {
    const auto cx = static_cast<int32_t>(std::floor(x / resolution)),
               cy = static_cast<int32_t>(std::floor(y / resolution));
    block = static_cast<uint64_t>(static_cast<uint32_t>(cx >> 3)) << 32 | static_cast<uint32_t>(cy >> 3);
    bit = uint64_t{1} << ((cy & 7) * 8 + (cx & 7));
  }
};

/** Which cells of a block of the lattice one submap, and which several, saw. */
struct SeenBy {
  uint64_t any = 0, several = 0;
};

/** Calls visit(cell) for the cell of the lattice under each observed cell of the submap. */
template <class Visit>
void forEachObservedCell(const GridSubmap& submap, const mrpt::poses::CPosePDFGaussian& T_w_s,
                         double resolution, Visit visit) {
  const auto evidence = submap.packedEvidence();
  const auto T = T_w_s.mean.asTPose();
  const double c = std::cos(T.phi), s = std::sin(T.phi), r = evidence->resolution();
  evidence->forEachObserved([&](int cx, int cy, float, float) {
    const double x = evidence->xMin() + (cx + 0.5) * r, y = evidence->yMin() + (cy + 0.5) * r;
    visit(LatticeCell(T.x + c * x - s * y, T.y + s * x + c * y, resolution));
  });
}

}  // namespace

std::vector<double> overlapShares(const GridSubmaps& submaps, const Frames& frames) {
  double resolution = std::numeric_limits<double>::infinity();
  for (const auto& submap : submaps) resolution = std::min(resolution, submap->resolution());
  std::unordered_map<uint64_t, SeenBy> seen;
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    std::unordered_map<uint64_t, uint64_t> own;  // a submap that sees a cell twice is still one
    forEachObservedCell(*submaps[i], frames[i], resolution,
                        [&](const LatticeCell& cell) { own[cell.block] |= cell.bit; });
    for (const auto& [block, bits] : own) {
      SeenBy& by = seen[block];
      by.several |= by.any & bits;
      by.any |= bits;
    }
  }
  std::vector<double> shares;
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    std::size_t observed = 0, shared = 0;
    forEachObservedCell(*submaps[i], frames[i], resolution, [&](const LatticeCell& cell) {
      ++observed;
      shared += (seen[cell.block].several & cell.bit) != 0;
    });
    shares.push_back(observed ? static_cast<double>(shared) / static_cast<double>(observed) : 0);
  }
  return shares;
}

}  // namespace submap_slam
