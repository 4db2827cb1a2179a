#include <submap_slam/core/joined_map.h>

#include <malloc.h>
#include <submap_slam/core/map_resolution.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

namespace submap_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using mrpt::poses::CPosePDFGaussian;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/** Largest map that is made without being asked for: 160 MB if all of it is observed. */
constexpr double kMostCells = 2e7;

/** The map is made in squares of that many cells a side, so that the sums take little memory, and only the
 * evidence of the submaps that reach into a square is needed at a time. */
constexpr int kTile = 1024;

/** Submaps whose evidence is held at once. */
constexpr std::size_t kTogether = 8;

/** Fewer hits than this come from rounding where a look-up falls on the centre of a neighbouring cell. */
constexpr double kLeastHits = 1e-6;

/** Σ N_i L_i, Σ N_i², Σ N_i of one cell. */
struct FusionSums {
  double nl = 0, nn = 0, n = 0;
};

/** Limits in the global map frame (m). */
struct Box {
  double x_min = kInfinity, x_max = -kInfinity, y_min = kInfinity, y_max = -kInfinity;

  void extend(const TPoint2D& p) {
    x_min = std::min(x_min, p.x), x_max = std::max(x_max, p.x);
    y_min = std::min(y_min, p.y), y_max = std::max(y_max, p.y);
  }
  bool meets(const Box& other) const {
    return x_min <= other.x_max && other.x_min <= x_max && y_min <= other.y_max && other.y_min <= y_max;
  }
};

/** A submap in the global map frame. */
class PlacedSubmap {
 public:
  PlacedSubmap(const GridSubmap& submap, const TPose2D& T_w_s)
      : submap_(&submap),
        grid_(submap.evidenceSummary()),
        T_w_s_(T_w_s),
        cos_(std::cos(T_w_s.phi)),
        sin_(std::sin(T_w_s.phi)) {
    const double r = grid_.resolution;
    for (const double u : {-1.0, grid_.columns * 1.0})
      for (const double v : {-1.0, grid_.rows * 1.0})
        box_.extend(T_w_s_.composePoint({grid_.x_min + (u + 0.5) * r, grid_.y_min + (v + 0.5) * r}));
  }

  bool empty() const { return grid_.stored_cells == 0; }
  double resolution() const { return grid_.resolution; }
  std::shared_ptr<const PackedEvidence> evidence() const { return submap_->packedEvidence(); }

  /** Everything that interpolation reaches. */
  const Box& box() const { return box_; }

  /** Index coordinates (cell centres are integers) of a global point (m). */
  TPoint2D toIndex(double x, double y) const {
    const double dx = x - T_w_s_.x, dy = y - T_w_s_.y, r = grid_.resolution;
    return {(cos_ * dx + sin_ * dy - grid_.x_min) / r - 0.5,
            (-sin_ * dx + cos_ * dy - grid_.y_min) / r - 0.5};
  }

  /** Those k in [first, end) for which start + k·step can reach a cell, as a half-open interval. */
  std::pair<int, int> reach(const TPoint2D& start, const TPoint2D& step, int first, int end) const {
    double from = first, to = end - 1;
    clip(start.x, step.x, -1, grid_.columns, from, to);
    clip(start.y, step.y, -1, grid_.rows, from, to);
    if (from > to) return {0, 0};
    return {static_cast<int>(std::ceil(from)), static_cast<int>(std::floor(to)) + 1};
  }

 private:
  static void clip(double start, double step, double low, double high, double& from, double& to) {
    if (std::abs(step) < 1e-12) {
      if (start <= low || start >= high) to = from - 1;
      return;
    }
    const double a = (low - start) / step, b = (high - start) / step;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }

  const GridSubmap* submap_;
  EvidenceSummary grid_;
  TPose2D T_w_s_;
  double cos_, sin_;
  Box box_;
};

/** Adds the bilinear log-odds sum and hit count to the sums of a cell of the map; cells outside count as
 * unknown. */
void addTo(FusionSums& sums, const PackedEvidence& evidence, const TPoint2D& index) {
  const double fx = std::floor(index.x), fy = std::floor(index.y);
  const int cx = static_cast<int>(fx), cy = static_cast<int>(fy);
  if (!evidence.mayReach(cx, cy)) return;
  const double a = index.x - fx, b = index.y - fy;
  double log_odds = 0, hits = 0;
  const auto add = [&](int x, int y, double weight) {
    const auto [l, n] = evidence.cell(x, y);
    log_odds += weight * static_cast<double>(l);
    hits += weight * static_cast<double>(n);
  };
  add(cx, cy, (1 - a) * (1 - b));
  add(cx + 1, cy, a * (1 - b));
  add(cx, cy + 1, (1 - a) * b);
  add(cx + 1, cy + 1, a * b);
  sums.nl += hits * log_odds, sums.nn += hits * hits, sums.n += hits;
}

/** The lattice of the global map: where its cells are. */
class MapLattice {
 public:
  MapLattice(const Box& box, double r)
      : along_x_(box.x_min, box.x_max, 0, r, r), along_y_(0, r, box.y_min, box.y_max, r) {}

  int columns() const { return static_cast<int>(along_x_.sizeX()); }
  int rows() const { return static_cast<int>(along_y_.sizeY()); }
  double resolution() const { return along_x_.resolution(); }
  double xOf(int column) const { return along_x_.hits.idx2x(column); }
  double yOf(int row) const { return along_y_.hits.idx2y(row); }

  /** The part of the map from cell (column, row) on, without any evidence yet. */
  PackedEvidence part(int column, int row, int width, int height) const {
    const double r = resolution(), x0 = along_x_.hits.getXMin(), y0 = along_y_.hits.getYMin();
    return {x0 + r * column, x0 + r * (column + width), y0 + r * row, y0 + r * (row + height), r};
  }

 private:
  EvidenceGrid along_x_, along_y_;  // one row and one column, which round as the whole would
};

/** A square of the map while it is made. */
class FusionTile {
 public:
  FusionTile(const MapLattice& map, int column, int row)
      : map_(map),
        column_(column),
        row_(row),
        width_(std::min(kTile, map.columns() - column)),
        height_(std::min(kTile, map.rows() - row)),
        sums_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

  Box box() const {
    Box box;
    box.extend({map_.xOf(column_), map_.yOf(row_)});
    box.extend({map_.xOf(column_ + width_ - 1), map_.yOf(row_ + height_ - 1)});
    return box;
  }

  /** Adds the submaps in the order given. */
  void add(const std::vector<const PlacedSubmap*>& submaps) {
    for (std::size_t first = 0; first < submaps.size(); first += kTogether) {
      const std::size_t count = std::min(kTogether, submaps.size() - first);
      std::vector<std::shared_ptr<const PackedEvidence>> evidence(count);
      tbb::parallel_for(std::size_t{0}, count,
                        [&](std::size_t i) { evidence[i] = submaps[first + i]->evidence(); });
      tbb::parallel_for(0, height_, [&](int row) {
        for (std::size_t i = 0; i < count; ++i) addRow(row, *submaps[first + i], *evidence[i]);
      });
    }
  }

  PackedEvidence fused() const {
    PackedEvidence evidence = map_.part(column_, row_, width_, height_);
    auto s = sums_.begin();
    for (int cy = 0; cy < height_; ++cy)
      for (int cx = 0; cx < width_; ++cx, ++s)
        if (s->n >= kLeastHits)
          evidence.set(cx, cy, static_cast<float>(s->n * s->nl / s->nn), static_cast<float>(s->n));
    return PackedEvidence(evidence);  // without the room for blocks that nobody saw
  }

 private:
  void addRow(int row, const PlacedSubmap& submap, const PackedEvidence& evidence) {
    const double x0 = map_.xOf(0), y = map_.yOf(row_ + row);
    const auto start = submap.toIndex(x0, y), step = submap.toIndex(x0 + map_.resolution(), y) - start;
    const auto [from, to] = submap.reach(start, step, column_, column_ + width_);
    for (int k = from; k < to; ++k)
      addTo(sums_[static_cast<std::size_t>(row * width_ + k - column_)], evidence, start + step * k);
  }

  const MapLattice& map_;
  int column_, row_, width_, height_;
  std::vector<FusionSums> sums_;  // row by row
};

struct FusedTile {
  int column, row;  ///< of its first cell in the map
  PackedEvidence evidence;
};

FusedTile fuseTile(const MapLattice& map, int column, int row, const std::vector<PlacedSubmap>& placed) {
  FusionTile tile(map, column, row);
  std::vector<const PlacedSubmap*> members;
  const Box box = tile.box();
  for (const PlacedSubmap& submap : placed)
    if (submap.box().meets(box)) members.push_back(&submap);
  tile.add(members);
  return {column, row, tile.fused()};
}

/** The smallest grid that holds every observed cell. The tiles are given up one by one, not to have the map
 * twice. */
PackedEvidence assembled(const MapLattice& map, std::vector<FusedTile> tiles) {
  int left = map.columns(), right = -1, low = map.rows(), high = -1;
  for (const FusedTile& tile : tiles)
    if (const CellRange seen = tile.evidence.observedRange(); !seen.empty()) {
      left = std::min(left, tile.column + seen.x_first), right = std::max(right, tile.column + seen.x_last);
      low = std::min(low, tile.row + seen.y_first), high = std::max(high, tile.row + seen.y_last);
    }
  if (right < left) return PackedEvidence(0, map.resolution(), 0, map.resolution(), map.resolution());
  PackedEvidence whole = map.part(left, low, right - left + 1, high - low + 1);
  for (; !tiles.empty(); tiles.pop_back()) {
    const FusedTile& tile = tiles.back();
    tile.evidence.forEachObserved([&](int cx, int cy, float log_odds, float hits) {
      whole.set(tile.column + cx - left, tile.row + cy - low, log_odds, hits);
    });
  }
  malloc_trim(0);  // the tiles left holes in the heap, and the cells are about to be there twice
  return PackedEvidence(whole);  // without the room for blocks that nobody saw
}

/** The submaps that saw something. */
std::vector<PlacedSubmap> placedSubmaps(const GridSubmaps& submaps,
                                        const std::vector<CPosePDFGaussian>& frames) {
  if (submaps.size() != frames.size()) throw std::invalid_argument("one frame is needed for each submap");
  std::vector<PlacedSubmap> placed;
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    const PlacedSubmap submap(*submaps[k], frames[k].mean.asTPose());
    if (!submap.empty()) placed.push_back(submap);
  }
  return placed;
}

Box boxOf(const std::vector<PlacedSubmap>& placed) {
  Box box;
  for (const PlacedSubmap& submap : placed) {
    box.extend({submap.box().x_min, submap.box().y_min});
    box.extend({submap.box().x_max, submap.box().y_max});
  }
  return box;
}

double resolutionOf(const std::vector<PlacedSubmap>& placed, double wanted) {
  if (wanted > 0 || placed.empty()) return wanted;
  double finest = kInfinity;
  for (const PlacedSubmap& submap : placed) finest = std::min(finest, submap.resolution());
  const Box box = boxOf(placed);
  const double area = (box.x_max - box.x_min) * (box.y_max - box.y_min);
  while (area > kMostCells * finest * finest) finest *= 2;
  return finest;
}

}  // namespace

double mapResolution(const GridSubmaps& submaps, const std::vector<CPosePDFGaussian>& frames, double wanted) {
  const auto placed = placedSubmaps(submaps, frames);
  return placed.empty() ? 0 : resolutionOf(placed, wanted);
}

PackedEvidence fuseEvidence(const GridSubmaps& submaps, const std::vector<CPosePDFGaussian>& frames,
                            double resolution) {
  const std::vector<PlacedSubmap> placed = placedSubmaps(submaps, frames);
  if (placed.empty()) return {};
  const MapLattice map(boxOf(placed), resolutionOf(placed, resolution));
  std::vector<FusedTile> tiles;
  for (int row = 0; row < map.rows(); row += kTile)
    for (int column = 0; column < map.columns(); column += kTile)
      tiles.push_back(fuseTile(map, column, row, placed));
  return assembled(map, std::move(tiles));
}

}  // namespace submap_slam
