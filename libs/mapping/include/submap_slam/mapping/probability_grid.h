#pragma once

#include <mrpt/containers/CDynamicGrid.h>
#include <mrpt/math/TPose2D.h>
#include <submap_slam/mapping/laser_points.h>

#include <algorithm>
#include <cstdint>

namespace submap_slam {

/** Huang et al. 2024, eq. (2), (3). */
struct ProbabilityGridParams {
  double resolution = 0.1;  ///< m
  double hit = 0.7;         ///< probability that a cell is occupied if one beam ends in it, > ½
  double miss = 0.4;        ///< … if one beam passes through it, < ½
  double min = 0.1;         ///< cells are never surer to be free
  double max = 0.95;        ///< … or to be occupied
};

/** odds(p) = p / (1 − p), eq. (2). */
inline double odds(double probability) { return probability / (1 - probability); }

/** odds⁻¹(o). */
inline double probabilityOf(double odds) { return odds / (1 + odds); }

/** Probability that cells are occupied, kept by products of odds.
 *
 * Frame: local map frame. A cell starts at ½; each scan multiplies its odds once: by odds(hit) if a beam ends
 * in it, else by odds(miss) if one passes through it. The result is clamped to [min, max], eq. (3).
 * Not thread-safe.
 */
class ProbabilityGrid {
 public:
  explicit ProbabilityGrid(const ProbabilityGridParams& params);

  /** Adds what was seen from T_s_robot.
   * @param max_range m; longer beams pass through cells up to there, but end in none */
  void insert(const LaserPoints& scan, const mrpt::math::TPose2D& T_s_robot, double max_range);

  /** Of the cell in that column and row; `min` where nothing was seen: a beam that ends there is not
   * explained. */
  double probability(int column, int row) const {
    const Cell* cell = cells_.cellByIndex(static_cast<unsigned>(column), static_cast<unsigned>(row));
    return cell ? std::max(static_cast<double>(cell->probability), params_.min) : params_.min;
  }

  /** Column and row of the cell whose centre is at that coordinate, with a fraction between centres. */
  template <class T>
  T columnOf(const T& x) const {
    return (x - cells_.getXMin()) / params_.resolution - 0.5;
  }
  template <class T>
  T rowOf(const T& y) const {
    return (y - cells_.getYMin()) / params_.resolution - 0.5;
  }

  bool empty() const { return insertion_ == 0; }

 private:
  struct Cell {
    float probability = 0;   ///< 0: never seen
    uint32_t insertion = 0;  ///< number of the last one that changed it
  };
  void growTo(double x_min, double y_min, double x_max, double y_max);
  void update(int column, int row, double odds_factor);

  ProbabilityGridParams params_;
  mrpt::containers::CDynamicGrid<Cell> cells_;
  uint32_t insertion_ = 0;  ///< how many scans were inserted
};

}  // namespace submap_slam
