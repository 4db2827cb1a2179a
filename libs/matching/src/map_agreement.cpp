#include <submap_slam/matching/map_agreement.h>

#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

/** The bits of columns left … right and rows low … high of a block, all within 0 … 7. */
uint64_t rectangle(int left, int right, int low, int high) {
  const uint64_t row = (uint64_t{0xff} >> (7 - (right - left))) << left;
  const uint64_t rows = (~uint64_t{0} >> (8 * (7 - (high - low)))) << (8 * low);
  return (row * 0x0101010101010101u) & rows;
}

}  // namespace

AgreementMap::AgreementMap(const PackedEvidence& evidence, const AgreementParams& params)
    : x_min_(evidence.xMin()),
      y_min_(evidence.yMin()),
      resolution_(evidence.resolution()),
      reach_(static_cast<int>(std::lround(params.tolerance / resolution_))),
      columns_((evidence.sizeX() + kMask) >> kShift),
      rows_((evidence.sizeY() + kMask) >> kShift),
      numbers_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0),
      blocks_(1) {
  evidence.forEachObserved([&](int cx, int cy, float log_odds, float hits) {
    const bool occupied = log_odds > 0, free = static_cast<double>(hits) >= params.free_hits;
    if (!occupied && !free) return;
    const uint64_t bit = uint64_t{1} << (((cy & kMask) << kShift) + (cx & kMask));
    Block& block = writableBlock(cx >> kShift, cy >> kShift);
    if (occupied) block.occupied |= bit;
    if (free) block.free |= bit;
  });
  blocks_.shrink_to_fit();
}

AgreementMap::Block& AgreementMap::writableBlock(int bx, int by) {
  uint32_t& number = numbers_[indexOf(bx, by)];
  if (number == 0) {
    number = static_cast<uint32_t>(blocks_.size());
    blocks_.emplace_back();
  }
  return blocks_[number];
}

/** Whether any cell of columns left … right and rows low … high is occupied. */
bool AgreementMap::isOccupiedWithin(int left, int right, int low, int high) const {
  for (int by = low >> kShift; by <= high >> kShift; ++by)
    for (int bx = left >> kShift; bx <= right >> kShift; ++bx) {
      const int x0 = bx * kSide, y0 = by * kSide;  // shifting negative numbers would be undefined
      const uint64_t asked = rectangle(std::max(0, left - x0), std::min(kMask, right - x0),
                                       std::max(0, low - y0), std::min(kMask, high - y0));
      if ((blockAt(bx, by).occupied & asked) != 0) return true;
    }
  return false;
}

AgreementMap::Finding AgreementMap::at(double x, double y) const {
  const int cx = static_cast<int>(std::floor((x - x_min_) / resolution_));
  const int cy = static_cast<int>(std::floor((y - y_min_) / resolution_));
  if (isOccupiedWithin(cx - reach_, cx + reach_, cy - reach_, cy + reach_)) return Finding::kHit;
  const uint64_t bit = rectangle(cx & kMask, cx & kMask, cy & kMask, cy & kMask);
  return (blockAt(cx >> kShift, cy >> kShift).free & bit) != 0 ? Finding::kFree : Finding::kUnknown;
}

MapAgreement agreementOf(const LaserPoints& points, const AgreementMap& map,
                         const mrpt::math::TPose2D& T_map_points) {
  const double c = std::cos(T_map_points.phi), s = std::sin(T_map_points.phi);
  std::size_t hits = 0, contradictions = 0;
  for (const LaserPoint& p : points.points) {
    const double px = static_cast<double>(p.x), py = static_cast<double>(p.y);
    const auto finding = map.at(T_map_points.x + c * px - s * py, T_map_points.y + s * px + c * py);
    hits += finding == AgreementMap::Finding::kHit;
    contradictions += finding == AgreementMap::Finding::kFree;
  }
  MapAgreement out;
  if (points.points.empty()) return out;
  out.hit_share = static_cast<double>(hits) / static_cast<double>(points.points.size());
  if (hits + contradictions > 0)
    out.agreement = static_cast<double>(hits) / static_cast<double>(hits + contradictions);
  return out;
}

}  // namespace submap_slam
