#pragma once

#include <mrpt/containers/CDynamicGrid.h>
#include <mrpt/serialization/CArchive.h>

#include <utility>

namespace submap_slam {

/** MRPT's grid, which can be moved too: large maps are handed on without a second copy. */
class EvidenceLayer : public mrpt::containers::CDynamicGrid<float> {
 public:
  using CDynamicGrid::CDynamicGrid;
  EvidenceLayer(const EvidenceLayer&) = default;
  EvidenceLayer(EvidenceLayer&& other) noexcept : EvidenceLayer(0, 1, 0, 1, 1) { swap(other); }
  EvidenceLayer& operator=(const EvidenceLayer&) = default;
  EvidenceLayer& operator=(EvidenceLayer&& other) noexcept {
    EvidenceLayer taken(std::move(other));
    swap(taken);
    return *this;
  }
  ~EvidenceLayer() override = default;

 private:
  void swap(EvidenceLayer& other) noexcept;
};

/** Un-saturated occupancy evidence on a regular grid.
 *
 * Cell (cx, cy) has its centre at (x_min + (cx + ½) r, y_min + (cy + ½) r). `log_odds` is the **sum** of the
 * log-odds of all observations of the cell, positive = occupied (MRPT's own grids have positive = free);
 * `hits` is how many observations there were (fractions arise from bilinear splatting). A cell with hits = 0
 * is unknown and has log_odds = 0. Both grids always have the same extent.
 */
struct EvidenceGrid {
  EvidenceLayer log_odds;
  EvidenceLayer hits;

  /** An empty (1 × 1 cell) grid. */
  EvidenceGrid();

  /** All cells unknown; limits in metres are rounded outwards to multiples of the resolution (m per cell). */
  EvidenceGrid(double x_min, double x_max, double y_min, double y_max, double resolution);

  double resolution() const { return log_odds.getResolution(); }
  std::size_t sizeX() const { return log_odds.getSizeX(); }
  std::size_t sizeY() const { return log_odds.getSizeY(); }
  std::size_t cells() const { return sizeX() * sizeY(); }

  /** Number of cells with hits > 0. */
  std::size_t observedCells() const;

  /** The smallest grid with the same lattice that holds every observed cell; one unknown cell if there is
   * none. */
  EvidenceGrid cropped() const;

  void writeTo(mrpt::serialization::CArchive& out) const;

  /** Throws std::runtime_error if sizes are implausible or do not match. */
  static EvidenceGrid readFrom(mrpt::serialization::CArchive& in);
};

/** Probability that a cell is occupied, in (0, 1). */
double occupancyOf(float log_odds);

}  // namespace submap_slam
