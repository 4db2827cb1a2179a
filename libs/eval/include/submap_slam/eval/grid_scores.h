/** How well a grid map tells occupied cells from free ones. */
#pragma once

#include <submap_slam/core/evidence_grid.h>

#include <cstddef>
#include <optional>

namespace submap_slam {

/** Scores over the cells that both grids know; a cell is occupied if that is likelier than free. Cells are
 * ranked by their evidence as it is: in MRPT's 8-bit grids most cells are at one end of the scale or the
 * other, and ties would decide. */
struct GridScores {
  std::size_t cells = 0;     ///< known in both grids
  std::size_t occupied = 0;  ///< of these, occupied in the truth
  double coverage = 0;       ///< cells / cells that the truth knows

  /** Area under the ROC curve (Bradley, Pattern Recognition 30(7), 1997): the probability that a truly
   * occupied cell looks more occupied than a truly free one, ties counting half. Nothing if the truth has
   * only one of the two kinds. */
  std::optional<double> auc;
  std::optional<double> precision;  ///< of the cells called occupied, the share that is
  std::optional<double> recall;     ///< of the occupied cells, the share that is called so
  std::optional<double> accuracy;   ///< share of cells of either kind that are called what they are
};

/** Compares a grid with the true one. A cell without hits, or whose evidence speaks for neither, is unknown.
 * Both grids must be of the same frame; throws std::invalid_argument if they differ in resolution. Extents
 * may differ. */
GridScores scoreGrid(const EvidenceGrid& estimate, const EvidenceGrid& truth);

}  // namespace submap_slam
