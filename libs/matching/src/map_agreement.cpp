#include <submap_slam/matching/map_agreement.h>

#include <cmath>

namespace submap_slam {
namespace {

enum class Finding { kHit, kFree, kUnknown };

/** What is within `reach` cells of a cell: something occupied, only free space, or too little to say. */
Finding lookUp(const PackedEvidence& map, int cx, int cy, int reach, double free_hits) {
  for (int y = cy - reach; y <= cy + reach; ++y)
    for (int x = cx - reach; x <= cx + reach; ++x)
      if (map.cell(x, y).first > 0) return Finding::kHit;
  return static_cast<double>(map.cell(cx, cy).second) >= free_hits ? Finding::kFree : Finding::kUnknown;
}

}  // namespace

MapAgreement agreementOf(const LaserPoints& points, const PackedEvidence& map,
                         const mrpt::math::TPose2D& T_map_points, const AgreementParams& params) {
  const double c = std::cos(T_map_points.phi), s = std::sin(T_map_points.phi), r = map.resolution();
  const int reach = static_cast<int>(std::lround(params.tolerance / r));
  std::size_t hits = 0, contradictions = 0;
  for (const LaserPoint& p : points.points) {
    const double px = static_cast<double>(p.x), py = static_cast<double>(p.y);
    const double x = T_map_points.x + c * px - s * py, y = T_map_points.y + s * px + c * py;
    const Finding finding =
        lookUp(map, static_cast<int>(std::floor((x - map.xMin()) / r)),
               static_cast<int>(std::floor((y - map.yMin()) / r)), reach, params.free_hits);
    hits += finding == Finding::kHit;
    contradictions += finding == Finding::kFree;
  }
  MapAgreement out;
  if (points.points.empty()) return out;
  out.hit_share = static_cast<double>(hits) / static_cast<double>(points.points.size());
  if (hits + contradictions > 0)
    out.agreement = static_cast<double>(hits) / static_cast<double>(hits + contradictions);
  return out;
}

}  // namespace submap_slam
