#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/parameters.h>
#include <submap_slam/mapping/laser_points.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace submap_slam {

struct SurfelMapParams {
  double resolution = 0.05;    ///< m
  double search_radius = 0.3;  ///< m
  double fit_radius = 0.15;    ///< m
};

/** The surface element of one cell: statistics of the endpoints that fell into it, and the line through it
 * and its neighbours. */
struct Surfel {
  enum class Kind : uint8_t { kPoint, kLine };

  float x = 0, y = 0;                ///< mean of the endpoints: sub-cell position (m)
  float cos2 = 0, sin2 = 0;          ///< sums of cos 2α, sin 2α of the scan normals' directions α
  float facing_x = 0, facing_y = 0;  ///< sum of the scan normals (see LaserPoint): the side that was seen
  float hits = 0;
  float line_x = 0, line_y = 0, normal_x = 1, normal_y = 0;  ///< point on the line and its unit normal
  Kind kind = Kind::kPoint;

  /** Whether this is the other side of what has that normal (see LaserPoint), as the two faces of a thin wall
   * are. False in case of doubt. */
  bool facesAwayFrom(float nx, float ny) const {
    constexpr float kOpposite = -0.2f;
    return facing_x * nx + facing_y * ny < kOpposite * hits;
  }
};

/** The matching layer of a submap: a sparse map of surfels with, for each cell near a surface, its nearest
 * surfel.
 *
 * Frame: local map frame. Cells lie in 16 × 16 tiles which copies share until one of them writes, so that
 * hypotheses of a particle filter cost little. Not thread-safe.
 */
class SurfelMap {
 public:
  explicit SurfelMap(const SurfelMapParams& params);

  /** Adds the endpoints of a frame seen from T_s_robot and refits the lines around them. */
  void insert(const LaserPoints& scan, const mrpt::math::TPose2D& T_s_robot);

  /** Nearest surfel within the search radius (to the cell of the query), or null. */
  const Surfel* nearest(double x, double y) const {
    const int cx = cellOf(x), cy = cellOf(y);
    const Tile* tile = tileAt(cx >> kTileBits, cy >> kTileBits);
    if (!tile) return nullptr;
    const uint32_t surfel = tile->cells[cellInTile(cx, cy)].nearest;
    return surfel == kNone ? nullptr : &surfels_[surfel];
  }

  bool empty() const { return surfels_.empty(); }
  const std::vector<Surfel>& surfels() const { return surfels_; }

 private:
  static constexpr int kTileBits = 4, kTileSide = 1 << kTileBits, kTileMask = kTileSide - 1;
  static constexpr uint32_t kNone = UINT32_MAX;

  struct Cell {
    uint32_t own = kNone;      ///< surfel of this cell
    uint32_t nearest = kNone;  ///< nearest surfel within the search radius
    float distance2 = 1e9f;    ///< squared distance (cells²) from this cell to the cell of `nearest`
  };
  /** The surfels, itself included, in whose line fit a surfel takes part: those of the cells within the fit
   * radius. */
  struct Links {
    static constexpr uint32_t kCapacity = 31;
    uint32_t count = 0;
    std::array<uint32_t, kCapacity> surfels;

    void add(uint32_t surfel) {
      if (count < kCapacity) surfels[count++] = surfel;
    }
    const uint32_t* begin() const { return surfels.data(); }
    const uint32_t* end() const { return surfels.data() + count; }
  };
  struct Tile {
    std::array<Cell, kTileSide * kTileSide> cells;
  };

  /** Index of the cell along one axis. Truncation after a shift is floor() without its cost; maps stay within
   * ± 10⁶ cells. */
  int cellOf(double metres) const {
    constexpr int kShift = 1 << 20;
    return static_cast<int>(metres * inverse_resolution_ + kShift) - kShift;
  }
  static std::size_t cellInTile(int cx, int cy) {
    return static_cast<std::size_t>(((cy & kTileMask) << kTileBits) | (cx & kTileMask));
  }
  const Tile* tileAt(int tx, int ty) const {
    const auto ix = static_cast<unsigned>(tx - tile_x0_), iy = static_cast<unsigned>(ty - tile_y0_);
    return ix < tiles_x_ && iy < tiles_y_ ? directory_[iy * tiles_x_ + ix].get() : nullptr;
  }
  const Cell* cellAt(int cx, int cy) const;
  Cell& writableCell(int cx, int cy);
  Tile& writableTile(int tx, int ty);
  void growTo(int tx, int ty);
  void addEndpoint(double x, double y, float normal_x, float normal_y);
  void claimNeighbourhood(uint32_t surfel, int cx, int cy);
  void linkNeighbours(uint32_t surfel, int cx, int cy);
  void fitLine(uint32_t surfel);

  SurfelMapParams params_;
  double inverse_resolution_;
  int fit_cells_;
  std::vector<std::array<int, 2>> claim_offsets_;  ///< cells within the search radius
  std::vector<Surfel> surfels_;
  std::vector<Links> links_;        ///< of each surfel
  std::vector<uint32_t> changed_;   ///< surfels touched by the insertion under way
  std::vector<uint32_t> refit_at_;  ///< insertion number at which each surfel was refitted last
  uint32_t insertion_ = 0;
  std::vector<std::shared_ptr<Tile>> directory_;
  int tile_x0_ = 0, tile_y0_ = 0;
  unsigned tiles_x_ = 0, tiles_y_ = 0;
};

}  // namespace submap_slam
