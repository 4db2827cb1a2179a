#include "overlap.h"

#include <mrpt/containers/CDynamicGrid.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace submap_slam {
namespace {

using Frames = std::vector<mrpt::poses::CPosePDFGaussian>;
using Owners = mrpt::containers::CDynamicGrid<int32_t>;

constexpr int32_t kNobody = -1, kSeveral = -2;

/** Calls visit(x, y) with the centre of each observed cell in the global map frame. */
template <class Visit>
void forEachObservedCell(const GridSubmap& submap, const mrpt::poses::CPosePDFGaussian& T_w_s, Visit visit) {
  const LoadedEvidence evidence(submap);
  const auto& hits = evidence->hits;
  const auto T = T_w_s.mean.asTPose();
  const double c = std::cos(T.phi), s = std::sin(T.phi);
  for (std::size_t cy = 0; cy < hits.getSizeY(); ++cy) {
    for (std::size_t cx = 0; cx < hits.getSizeX(); ++cx) {
      const auto ix = static_cast<unsigned>(cx), iy = static_cast<unsigned>(cy);
      if (*hits.cellByIndex(ix, iy) <= 0) continue;
      const double x = hits.idx2x(static_cast<int>(cx)), y = hits.idx2y(static_cast<int>(cy));
      visit(T.x + c * x - s * y, T.y + s * x + c * y);
    }
  }
}

/** A grid around all submaps that nobody owns yet. */
Owners emptyOwners(const GridSubmaps& submaps, const Frames& frames) {
  const double infinity = std::numeric_limits<double>::infinity();
  double x_min = infinity, x_max = -infinity, y_min = infinity, y_max = -infinity, resolution = infinity;
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    const auto T = frames[i].mean.asTPose();
    const double r = submaps[i]->radius();
    x_min = std::min(x_min, T.x - r), x_max = std::max(x_max, T.x + r);
    y_min = std::min(y_min, T.y - r), y_max = std::max(y_max, T.y + r);
    resolution = std::min(resolution, submaps[i]->resolution());
  }
  const double margin = 2 * resolution;
  Owners owners(x_min - margin, x_max + margin, y_min - margin, y_max + margin, resolution);
  owners.fill(kNobody);
  return owners;
}

}  // namespace

std::vector<double> overlapShares(const GridSubmaps& submaps, const Frames& frames) {
  if (submaps.empty()) return {};
  Owners owners = emptyOwners(submaps, frames);
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    const auto self = static_cast<int32_t>(i);
    forEachObservedCell(*submaps[i], frames[i], [&](double x, double y) {
      int32_t& owner = *owners.cellByPos(x, y);
      owner = owner == kNobody || owner == self ? self : kSeveral;
    });
  }
  std::vector<double> shares;
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    std::size_t observed = 0, shared = 0;
    forEachObservedCell(*submaps[i], frames[i], [&](double x, double y) {
      ++observed;
      shared += *owners.cellByPos(x, y) == kSeveral;
    });
    shares.push_back(observed ? static_cast<double>(shared) / static_cast<double>(observed) : 0);
  }
  return shares;
}

}  // namespace submap_slam
