#include "lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace submap_slam::grid_joining {
namespace {

int floorDiv(int value, int divisor) {
  return static_cast<int>(std::floor(static_cast<double>(value) / static_cast<double>(divisor)));
}

/** Narrows [from, to] to where low ≤ start + k·step ≤ high. */
void narrow(double start, double step, double high, double& from, double& to) {
  if (std::abs(step) < 1e-12) {
    if (start < 0 || start > high) to = from - 1;
    return;
  }
  const double a = -start / step, b = (high - start) / step;
  from = std::max(from, std::min(a, b));
  to = std::min(to, std::max(a, b));
}

}  // namespace

PlacedLevel::PlacedLevel(const EvidenceLevel& level, const mrpt::math::TPose2D& T_w_s, double lattice_angle)
    : level_(&level), cos_(std::cos(T_w_s.phi - lattice_angle)), sin_(std::sin(T_w_s.phi - lattice_angle)) {
  const double c = std::cos(T_w_s.phi), s = std::sin(T_w_s.phi);
  column0_ = level.columnOf(-c * T_w_s.x - s * T_w_s.y);
  row0_ = level.rowOf(s * T_w_s.x - c * T_w_s.y);
}

std::pair<int, int> PlacedLevel::clip(int a_begin, int a_end, int b) const {
  double from = 0, to = a_end - a_begin - 1;
  narrow(columnOf(a_begin, b), cos_, level_->columns() - 1, from, to);
  narrow(rowOf(a_begin, b), -sin_, level_->rows() - 1, from, to);
  if (to < from) return {a_begin, a_begin};
  int first = a_begin + static_cast<int>(std::ceil(from)), last = a_begin + static_cast<int>(std::floor(to));
  // The borders themselves, and rounding, are decided by the test the sampling relies on.
  while (first <= last && !contains(first, b)) ++first;
  while (last >= first && !contains(last, b)) --last;
  return {first, last + 1};
}

PlacedLevel::Bounds PlacedLevel::bounds() const {
  double a_min = std::numeric_limits<double>::infinity(), a_max = -a_min, b_min = a_min, b_max = -a_min;
  for (const int u : {0, level_->columns() - 1})
    for (const int v : {0, level_->rows() - 1}) {
      const double du = u - column0_, dv = v - row0_;
      const double a = cos_ * du - sin_ * dv, b = sin_ * du + cos_ * dv;
      a_min = std::min(a_min, a), a_max = std::max(a_max, a);
      b_min = std::min(b_min, b), b_max = std::max(b_max, b);
    }
  return {static_cast<int>(std::floor(a_min)), static_cast<int>(std::ceil(a_max)) + 1,
          static_cast<int>(std::floor(b_min)), static_cast<int>(std::ceil(b_max)) + 1};
}

bool PlacedLevel::touchesTile(int a, int b) const {
  const double half_a = 0.5 * (kTileColumns - 1), half_b = 0.5 * (kTileRows - 1);
  const double a_mid = a + half_a, b_mid = b + half_b;
  const double column = column0_ + cos_ * a_mid + sin_ * b_mid, row = row0_ - sin_ * a_mid + cos_ * b_mid;
  const double reach_u = std::abs(cos_) * half_a + std::abs(sin_) * half_b;
  const double reach_v = std::abs(sin_) * half_a + std::abs(cos_) * half_b;
  return column + reach_u >= 0 && column - reach_u <= level_->columns() - 1 && row + reach_v >= 0 &&
         row - reach_v <= level_->rows() - 1;
}

std::vector<PlacedLevel> placeAll(const EvidenceLevels& level, const Frames& frames, double lattice_angle) {
  std::vector<PlacedLevel> placed;
  placed.reserve(level.size());
  for (std::size_t i = 0; i < level.size(); ++i) placed.emplace_back(level[i], frames[i], lattice_angle);
  return placed;
}

std::vector<Tile> overlapTiles(const std::vector<PlacedLevel>& placed) {
  struct Entry {
    int b, a;
    std::size_t submap;
    bool operator<(const Entry& other) const {
      return std::tie(b, a, submap) < std::tie(other.b, other.a, other.submap);
    }
  };
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (placed[i].level().empty()) continue;
    const auto box = placed[i].bounds();
    for (int b = floorDiv(box.b_min, kTileRows) * kTileRows; b < box.b_max; b += kTileRows)
      for (int a = floorDiv(box.a_min, kTileColumns) * kTileColumns; a < box.a_max; a += kTileColumns)
        if (placed[i].touchesTile(a, b)) entries.push_back({b, a, i});
  }
  std::sort(entries.begin(), entries.end());

  std::vector<Tile> tiles;
  for (std::size_t first = 0, next = 0; first < entries.size(); first = next) {
    Tile tile{entries[first].a, entries[first].b, {}};
    for (; next < entries.size() && entries[next].a == tile.a && entries[next].b == tile.b; ++next)
      tile.submaps.push_back(entries[next].submap);
    if (tile.submaps.size() > 1) tiles.push_back(std::move(tile));
  }
  return tiles;
}

}  // namespace submap_slam::grid_joining
