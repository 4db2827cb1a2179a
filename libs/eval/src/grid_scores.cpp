#include <submap_slam/eval/grid_scores.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace submap_slam {
namespace {

/** A cell that both grids know. */
struct Cell {
  float log_odds;  ///< of the estimate
  bool occupied;   ///< in the truth
};

/** Evidence of a cell; 0 if nothing is known of it. */
float evidenceAt(const EvidenceGrid& grid, int x, int y) {
  const bool inside =
      x >= 0 && y >= 0 && x < static_cast<int>(grid.sizeX()) && y < static_cast<int>(grid.sizeY());
  return inside ? *grid.log_odds.cellByIndex(static_cast<unsigned>(x), static_cast<unsigned>(y)) : 0.0f;
}

/** Cells by which the truth's origin lies right of or above the estimate's; both are at multiples of the
 * resolution. */
int cellsBetween(double estimate_min, double truth_min, double resolution) {
  return static_cast<int>(std::lround((truth_min - estimate_min) / resolution));
}

/** Area under the ROC curve as the normalised Mann-Whitney statistic; sorts the cells. */
double areaUnderCurve(std::vector<Cell>& cells, double occupied, double free) {
  std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.log_odds > b.log_odds; });
  double ordered_pairs = 0, free_after = free;
  for (std::size_t i = 0; i < cells.size();) {
    double tied_occupied = 0, tied_free = 0;
    const float value = cells[i].log_odds;
    for (; i < cells.size() && cells[i].log_odds == value; ++i)
      (cells[i].occupied ? tied_occupied : tied_free) += 1;
    free_after -= tied_free;
    ordered_pairs += tied_occupied * (free_after + tied_free / 2);
  }
  return ordered_pairs / (occupied * free);
}

/** Numbers of cells by what they are and what they are called. */
struct Confusion {
  double true_occupied = 0, false_occupied = 0, true_free = 0, false_free = 0;

  void add(const Cell& cell) {
    const bool called_occupied = cell.log_odds > 0;
    if (cell.occupied) {
      (called_occupied ? true_occupied : false_free) += 1;
    } else {
      (called_occupied ? false_occupied : true_free) += 1;
    }
  }
};

std::optional<double> share(double part, double rest) {
  if (part + rest == 0) return {};
  return part / (part + rest);
}

}  // namespace

GridScores scoreGrid(const EvidenceGrid& estimate, const EvidenceGrid& truth) {
  const double resolution = truth.resolution();
  constexpr double kSameResolution = 1e-6;
  if (std::abs(estimate.resolution() - resolution) > kSameResolution)
    throw std::invalid_argument("scoreGrid: the grids differ in resolution");
  const int shift_x = cellsBetween(estimate.hits.getXMin(), truth.hits.getXMin(), resolution);
  const int shift_y = cellsBetween(estimate.hits.getYMin(), truth.hits.getYMin(), resolution);

  std::vector<Cell> cells;
  std::size_t known_truth = 0;
  for (int y = 0; y < static_cast<int>(truth.sizeY()); ++y)
    for (int x = 0; x < static_cast<int>(truth.sizeX()); ++x) {
      const float wanted = evidenceAt(truth, x, y);
      if (wanted == 0) continue;
      ++known_truth;
      const float found = evidenceAt(estimate, x + shift_x, y + shift_y);
      if (found != 0) cells.push_back({found, wanted > 0});
    }

  Confusion confusion;
  for (const Cell& cell : cells) confusion.add(cell);
  const double occupied = confusion.true_occupied + confusion.false_free;
  const double free = confusion.true_free + confusion.false_occupied;
  GridScores scores;
  scores.cells = cells.size();
  scores.occupied = static_cast<std::size_t>(occupied);
  scores.coverage =
      known_truth > 0 ? static_cast<double>(cells.size()) / static_cast<double>(known_truth) : 0;
  scores.precision = share(confusion.true_occupied, confusion.false_occupied);
  scores.recall = share(confusion.true_occupied, confusion.false_free);
  scores.accuracy =
      share(confusion.true_occupied + confusion.true_free, confusion.false_occupied + confusion.false_free);
  if (occupied > 0 && free > 0) scores.auc = areaUnderCurve(cells, occupied, free);
  return scores;
}

}  // namespace submap_slam
