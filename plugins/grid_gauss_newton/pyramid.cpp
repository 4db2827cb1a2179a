#include "pyramid.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace submap_slam::grid_joining {
namespace {

/** Log-odds that differ from the background by a smaller share are rounding of the sums. */
constexpr double kRounding = 1e-4;

float aboveBackground(float log_odds, float hits, double background) {
  const double expected = background * static_cast<double>(hits);
  const double excess = static_cast<double>(log_odds) - expected;
  return std::abs(excess) <= kRounding * std::abs(expected) ? 0.0f : static_cast<float>(excess);
}

/** Values of a stored block at a cell and its neighbours, in the order (0, 0), (1, 0), (0, 1), (1, 1). */
std::array<double, 4> cornersOf(const float* block, int column, int row) {
  constexpr int kMask = EvidenceLevel::kBlock - 1;
  const float* low = block + (row & kMask) * EvidenceLevel::kStride + (column & kMask);
  const float* high = low + EvidenceLevel::kStride;
  return {static_cast<double>(low[0]), static_cast<double>(low[1]), static_cast<double>(high[0]),
          static_cast<double>(high[1])};
}

/** Bilinear value and gradient per cell of the four corners of a cell, in the order (0, 0), (1, 0), (0, 1),
 * (1, 1). */
void interpolate(const std::array<double, 4>& corner, double a, double b, double scale, double& value,
                 std::array<double, 2>& gradient) {
  const double lower = corner[1] - corner[0], upper = corner[3] - corner[2];
  const double bottom = corner[0] + a * lower, top = corner[2] + a * upper;
  value = bottom + b * (top - bottom);
  gradient = {scale * (lower + b * (upper - lower)), scale * (top - bottom)};
}

}  // namespace

EvidenceRaster::EvidenceRaster(double x0_m, double y0_m, double cell_size, int column_count, int row_count)
    : x0(x0_m),
      y0(y0_m),
      resolution(cell_size),
      columns(column_count),
      rows(row_count),
      cells(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

EvidenceRaster EvidenceRaster::fromEvidence(const PackedEvidence& evidence, double background) {
  int left = evidence.sizeX(), right = -1, bottom = evidence.sizeY(), top = -1;
  evidence.forEachObserved([&](int x, int y, float, float) {
    left = std::min(left, x), right = std::max(right, x);
    bottom = std::min(bottom, y), top = std::max(top, y);
  });
  if (right < left) return {};

  const double r = evidence.resolution();
  EvidenceRaster raster(evidence.xMin() + (left - 0.5) * r, evidence.yMin() + (bottom - 0.5) * r, r,
                        right - left + 3, top - bottom + 3);
  evidence.forEachObserved([&](int x, int y, float log_odds, float hits) {
    raster.cell(x - left + 1, y - bottom + 1) = {aboveBackground(log_odds, hits, background), hits};
  });
  return raster;
}

EvidenceRaster EvidenceRaster::halved() const {
  if (cells.empty()) return {};
  // Cell 1 of the coarse raster holds cells 1 and 2 of this one; cell 0 stays the rim.
  const int inner_columns = (columns - 1) / 2, inner_rows = (rows - 1) / 2;
  EvidenceRaster coarse(x0 - 0.5 * resolution, y0 - 0.5 * resolution, 2 * resolution, inner_columns + 2,
                        inner_rows + 2);
  for (int r = 1; r < rows - 1; ++r)
    for (int c = 1; c < columns - 1; ++c) {
      EvidenceCell& sum = coarse.cell((c + 1) / 2, (r + 1) / 2);
      sum.log_odds += cell(c, r).log_odds;
      sum.hits += cell(c, r).hits;
    }
  return coarse;
}

void EvidenceRaster::standardise() {
  for (EvidenceCell& c : cells) {
    if (c.hits <= 0) continue;
    c.hits = std::sqrt(c.hits);
    c.log_odds /= c.hits;
  }
}

EvidenceLevel::EvidenceLevel(const EvidenceRaster& raster)
    : x0_(raster.x0), y0_(raster.y0), resolution_(raster.resolution) {
  if (raster.cells.empty()) return;
  const int columns = (raster.columns + kBlock - 1) / kBlock, rows = (raster.rows + kBlock - 1) / kBlock;
  table_columns_ = static_cast<std::size_t>(columns + 2 * kMargin);
  table_rows_ = static_cast<std::size_t>(rows + 2 * kMargin);
  numbers_.assign(table_columns_ * table_rows_, 0);
  stored_.resize(1);
  hits_.resize(kStored);
  log_odds_.resize(kStored);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) addBlock(raster, c, r);
  blocks_.shrink_to_fit();
  stored_.shrink_to_fit();
  hits_.shrink_to_fit();
  log_odds_.shrink_to_fit();
}

void EvidenceLevel::addBlock(const EvidenceRaster& raster, int block_column, int block_row) {
  const Block corner{block_column * kBlock, block_row * kBlock, 0};
  std::array<EvidenceCell, kStored> cells{};
  const int columns = std::min(kStride, raster.columns - corner.column);
  const int rows = std::min(kStride, raster.rows - corner.row);
  for (int r = 0; r < rows; ++r)
    std::copy_n(&raster.cell(corner.column, corner.row + r), columns, cells.begin() + r * kStride);
  if (std::none_of(cells.begin(), cells.end(), [](const EvidenceCell& c) { return c.hits > 0; })) return;

  Block block = corner;
  const auto above = [&cells](int c, int r) {
    return cells[static_cast<std::size_t>(r * kStride + c)].log_odds != 0;
  };
  for (int r = 0; r < kBlock; ++r)
    for (int c = 0; c < kBlock; ++c)
      if (above(c, r) || above(c + 1, r) || above(c, r + 1) || above(c + 1, r + 1))
        block.surface |= uint64_t{1} << (r * kBlock + c);
  numbers_[tableIndex(corner.column, corner.row)] = static_cast<int32_t>(stored_.size());
  blocks_.push_back(block);
  stored_.push_back({block.surface, block.surface != 0 ? log_odds_.size() : 0});
  for (const EvidenceCell& cell : cells) {
    hits_.push_back(cell.hits);
    if (block.surface != 0) log_odds_.push_back(cell.log_odds);
  }
}

EvidenceBlockTable EvidenceLevel::tableAt(int column, int row) const {
  const std::size_t index = tableIndex(column, row);
  return {&numbers_[index], static_cast<int>(table_columns_), stored_.data(), hits_.data(), log_odds_.data()};
}

bool EvidenceLevel::tableHolds(double column, double row) const {
  const double margin = kMargin * kBlock;
  return column >= -margin && row >= -margin &&
         column < kBlock * static_cast<double>(table_columns_) - margin &&
         row < kBlock * static_cast<double>(table_rows_) - margin;
}

EvidenceSample EvidenceLevel::sample(double column, double row) const {
  EvidenceSample s;
  if (!tableHolds(column, row)) return s;
  const double c = std::floor(column), r = std::floor(row);
  const int ci = static_cast<int>(c), ri = static_cast<int>(r);
  const auto number = static_cast<std::size_t>(numbers_[tableIndex(ci, ri)]);
  const double scale = 1 / resolution_;
  interpolate(cornersOf(&log_odds_[stored_[number].log_odds], ci, ri), column - c, row - r, scale, s.log_odds,
              s.log_odds_gradient);
  interpolate(cornersOf(&hits_[number * kStored], ci, ri), column - c, row - r, scale, s.hits,
              s.hits_gradient);
  return s;
}

double EvidenceLevel::hitsAt(double column, double row) const {
  if (!tableHolds(column, row)) return 0;
  const double c = std::floor(column), r = std::floor(row);
  const int ci = static_cast<int>(c), ri = static_cast<int>(r);
  const auto number = static_cast<std::size_t>(numbers_[tableIndex(ci, ri)]);
  if (number == 0) return 0;
  double hits = 0;
  std::array<double, 2> gradient{};
  interpolate(cornersOf(&hits_[number * kStored], ci, ri), column - c, row - r, 1, hits, gradient);
  return hits;
}

double backgroundOf(const GridSubmaps& submaps) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& submap : submaps) {
    const EvidenceSummary summary = submap->evidenceSummary();
    if (summary.observed_cells > 0) least = std::min(least, summary.least_log_odds_per_hit);
  }
  return std::isfinite(least) ? least : 0;
}

std::vector<int> halvingsToCoarsest(const GridSubmaps& submaps) {
  const auto isEmpty = [](const auto& submap) { return submap->evidenceSummary().stored_cells == 0; };
  const GridSubmap* coarsest = nullptr;
  for (const auto& submap : submaps)
    if (!isEmpty(submap) && (!coarsest || submap->resolution() > coarsest->resolution()))
      coarsest = submap.get();
  std::vector<int> halvings;
  for (const auto& submap : submaps) {
    halvings.push_back(0);
    if (isEmpty(submap)) continue;
    const double exact = std::log2(coarsest->resolution() / submap->resolution());
    if (std::abs(exact - std::round(exact)) > 1e-6)
      throw InputError(fmt::format(
          "submap {} has cells of {:g} m; expected {:g} m as in submap {}, or a half, a quarter, … of it",
          submap->id, submap->resolution(), coarsest->resolution(), coarsest->id));
    halvings.back() = static_cast<int>(std::lround(exact));
  }
  return halvings;
}

std::vector<EvidenceLevels> buildPyramid(const GridSubmaps& submaps, const PyramidShape& shape) {
  const std::vector<int> halvings = halvingsToCoarsest(submaps);
  std::vector<EvidenceLevels> pyramid(static_cast<std::size_t>(shape.levels), EvidenceLevels(submaps.size()));
  tbb::parallel_for(std::size_t{0}, submaps.size(), [&](std::size_t i) {
    EvidenceRaster raster = EvidenceRaster::fromEvidence(*submaps[i]->packedEvidence(), shape.background);
    for (int k = 0; k < shape.finest_level + halvings[i]; ++k) raster = raster.halved();
    for (std::size_t k = 0; k < pyramid.size(); ++k) {
      EvidenceRaster coarser = k + 1 < pyramid.size() ? raster.halved() : EvidenceRaster();
      if (k > 0) raster.standardise();
      pyramid[k][i] = EvidenceLevel(std::exchange(raster, std::move(coarser)));
    }
  });
  return pyramid;
}

}  // namespace submap_slam::grid_joining
