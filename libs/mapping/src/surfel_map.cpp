#include <submap_slam/mapping/surfel_map.h>

#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

/** A fitted patch is a line if its thickness is below this share of its length (both as standard deviations).
 */
constexpr double kMaxThickness = 0.4;
/** Shortest patch (standard deviation along the line, m) that fixes a direction. */
constexpr double kMinLength = 0.03;
/** Mean resultant length of the double-angle scan normals from which they are trusted. */
constexpr float kMinNormalAgreement = 0.7f;

/** Weighted first and second moments of points about a reference. */
struct Moments {
  double w = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

  void add(double weight, double dx, double dy) {
    w += weight;
    x += weight * dx;
    y += weight * dy;
    xx += weight * dx * dx;
    xy += weight * dx * dy;
    yy += weight * dy * dy;
  }
};

/** Two faces of a thin wall, which one line through both would blur. */
bool areOppositeFaces(const Surfel& a, const Surfel& b) {
  constexpr float kOpposite = -0.2f;
  return a.facing_x * b.facing_x + a.facing_y * b.facing_y < kOpposite * a.hits * b.hits;
}

}  // namespace

SurfelMap::SurfelMap(const SurfelMapParams& params)
    : params_(params),
      inverse_resolution_(1.0 / params.resolution),
      fit_cells_(static_cast<int>(std::ceil(params.fit_radius / params.resolution))) {
  constexpr double kRounding = 1e-6;  // 0.3 / 0.05 is a hair below 6
  const int reach = static_cast<int>(std::floor(params.search_radius / params.resolution + kRounding));
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx)
      if (dx * dx + dy * dy <= reach * reach) claim_offsets_.push_back({dx, dy});
}

const SurfelMap::Cell* SurfelMap::cellAt(int cx, int cy) const {
  const Tile* tile = tileAt(cx >> kTileBits, cy >> kTileBits);
  return tile ? &tile->cells[cellInTile(cx, cy)] : nullptr;
}

SurfelMap::Cell& SurfelMap::writableCell(int cx, int cy) {
  return writableTile(cx >> kTileBits, cy >> kTileBits).cells[cellInTile(cx, cy)];
}

SurfelMap::Tile& SurfelMap::writableTile(int tx, int ty) {
  growTo(tx, ty);
  auto& tile =
      directory_[static_cast<unsigned>(ty - tile_y0_) * tiles_x_ + static_cast<unsigned>(tx - tile_x0_)];
  if (!tile)
    tile = std::make_shared<Tile>();
  else if (tile.use_count() > 1)
    tile = std::make_shared<Tile>(*tile);
  return *tile;
}

void SurfelMap::growTo(int tx, int ty) {
  const auto ix = static_cast<unsigned>(tx - tile_x0_), iy = static_cast<unsigned>(ty - tile_y0_);
  if (ix < tiles_x_ && iy < tiles_y_) return;
  const int margin = 8 + static_cast<int>(std::max(tiles_x_, tiles_y_)) / 4;  // tiles; growth is rare
  const bool first = tiles_x_ == 0;
  const int x0 = std::min(first ? tx : tile_x0_, tx - margin),
            y0 = std::min(first ? ty : tile_y0_, ty - margin);
  const int x1 = std::max(first ? tx : tile_x0_ + static_cast<int>(tiles_x_), tx + margin + 1);
  const int y1 = std::max(first ? ty : tile_y0_ + static_cast<int>(tiles_y_), ty + margin + 1);
  const auto nx = static_cast<unsigned>(x1 - x0), ny = static_cast<unsigned>(y1 - y0);
  std::vector<std::shared_ptr<Tile>> grown(static_cast<std::size_t>(nx) * ny);
  for (unsigned y = 0; y < tiles_y_; ++y)
    for (unsigned x = 0; x < tiles_x_; ++x)
      grown[(y + static_cast<unsigned>(tile_y0_ - y0)) * nx + x + static_cast<unsigned>(tile_x0_ - x0)] =
          std::move(directory_[y * tiles_x_ + x]);
  directory_ = std::move(grown);
  tile_x0_ = x0, tile_y0_ = y0, tiles_x_ = nx, tiles_y_ = ny;
}

void SurfelMap::insert(const LaserPoints& scan, const mrpt::math::TPose2D& T_s_robot) {
  const double c = std::cos(T_s_robot.phi), s = std::sin(T_s_robot.phi);
  const auto cf = static_cast<float>(c), sf = static_cast<float>(s);
  ++insertion_;
  changed_.clear();
  for (const auto& p : scan.points) {
    const double px = static_cast<double>(p.x), py = static_cast<double>(p.y);
    addEndpoint(T_s_robot.x + c * px - s * py, T_s_robot.y + s * px + c * py,
                cf * p.normal_x - sf * p.normal_y, sf * p.normal_x + cf * p.normal_y);
  }
  for (const uint32_t surfel : changed_)
    for (const uint32_t affected : links_[surfel]) {
      if (refit_at_[affected] == insertion_) continue;
      refit_at_[affected] = insertion_;
      fitLine(affected);
    }
}

void SurfelMap::addEndpoint(double x, double y, float normal_x, float normal_y) {
  const int cx = cellOf(x), cy = cellOf(y);
  Cell& cell = writableCell(cx, cy);
  const bool is_new = cell.own == kNone;
  if (is_new) {
    cell.own = static_cast<uint32_t>(surfels_.size());
    surfels_.emplace_back();
    refit_at_.push_back(0);
    links_.emplace_back();
  }
  const uint32_t index = cell.own;
  if (is_new) {
    claimNeighbourhood(index, cx, cy);
    linkNeighbours(index, cx, cy);
  }

  Surfel& surfel = surfels_[index];
  surfel.hits += 1;
  surfel.x += (static_cast<float>(x) - surfel.x) / surfel.hits;
  surfel.y += (static_cast<float>(y) - surfel.y) / surfel.hits;
  const float norm2 = normal_x * normal_x + normal_y * normal_y;
  if (norm2 > 0) {
    surfel.cos2 += (normal_x * normal_x - normal_y * normal_y) / norm2;
    surfel.sin2 += 2 * normal_x * normal_y / norm2;
  }
  surfel.facing_x += normal_x;
  surfel.facing_y += normal_y;
  changed_.push_back(index);
}

void SurfelMap::claimNeighbourhood(uint32_t surfel, int cx, int cy) {
  Tile* tile = nullptr;
  int tx = 0, ty = 0;
  for (const auto& [dx, dy] : claim_offsets_) {
    const auto distance2 = static_cast<float>(dx * dx + dy * dy);
    const int x = cx + dx, y = cy + dy;
    if (!tile || x >> kTileBits != tx || y >> kTileBits != ty) {
      tx = x >> kTileBits, ty = y >> kTileBits;
      tile = &writableTile(tx, ty);
    }
    Cell& cell = tile->cells[cellInTile(x, y)];
    if (distance2 < cell.distance2) {
      cell.distance2 = distance2;
      cell.nearest = surfel;
    }
  }
}

void SurfelMap::linkNeighbours(uint32_t surfel, int cx, int cy) {
  links_[surfel].add(surfel);
  for (int y = cy - fit_cells_; y <= cy + fit_cells_; ++y)
    for (int x = cx - fit_cells_; x <= cx + fit_cells_; ++x) {
      const Cell* cell = cellAt(x, y);
      const bool within = (x - cx) * (x - cx) + (y - cy) * (y - cy) <= fit_cells_ * fit_cells_;
      if (!within || !cell || cell->own == kNone || cell->own == surfel) continue;
      links_[surfel].add(cell->own);
      links_[cell->own].add(surfel);
    }
}

void SurfelMap::fitLine(uint32_t index) {
  Surfel& surfel = surfels_[index];
  Moments m;
  int neighbours = 0;
  for (const uint32_t link : links_[index]) {
    const Surfel& other = surfels_[link];
    const double dx = static_cast<double>(other.x - surfel.x), dy = static_cast<double>(other.y - surfel.y);
    const bool within = dx * dx + dy * dy <= params_.fit_radius * params_.fit_radius;
    if (!within || areOppositeFaces(surfel, other)) continue;
    // Each endpoint counts the same: the noise of one wall spreads over two rows of cells, and weights that
    // favour the row with fewer endpoints would shift the line away from the wall.
    m.add(static_cast<double>(other.hits), dx, dy);
    ++neighbours;
  }
  const double mx = m.x / m.w, my = m.y / m.w;
  const double xx = m.xx / m.w - mx * mx, xy = m.xy / m.w - mx * my, yy = m.yy / m.w - my * my;
  // Eigenvalues of the 2 × 2 covariance in closed form.
  const double half_trace = 0.5 * (xx + yy), root = std::hypot(0.5 * (xx - yy), xy);
  const double large = half_trace + root, small = std::max(0.0, half_trace - root);
  if (neighbours >= 3 && large > kMinLength * kMinLength && small < kMaxThickness * kMaxThickness * large) {
    const double along = 0.5 * std::atan2(2 * xy, xx - yy);
    surfel.line_x = surfel.x + static_cast<float>(mx);
    surfel.line_y = surfel.y + static_cast<float>(my);
    surfel.normal_x = static_cast<float>(-std::sin(along));
    surfel.normal_y = static_cast<float>(std::cos(along));
    surfel.kind = Surfel::Kind::kLine;
    return;
  }
  surfel.line_x = surfel.x;
  surfel.line_y = surfel.y;
  const float agreement = std::hypot(surfel.cos2, surfel.sin2);
  if (agreement > kMinNormalAgreement * surfel.hits) {
    const float alpha = 0.5f * std::atan2(surfel.sin2, surfel.cos2);
    surfel.normal_x = std::cos(alpha);
    surfel.normal_y = std::sin(alpha);
    surfel.kind = Surfel::Kind::kLine;
  } else {
    surfel.kind = Surfel::Kind::kPoint;
  }
}

}  // namespace submap_slam
