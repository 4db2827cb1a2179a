#include "reduced_system.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <vector>

namespace submap_slam::grid_joining {
namespace {

/** More blocks than any machine has threads, few enough that adding them up costs nothing. */
constexpr std::size_t kBlocks = 64;

struct Observation {
  EvidenceSample value;
  double px = 0, py = 0;  ///< point in the local map frame (m)
};

/** Working memory for one tile, and its sums in the submaps' own axes. */
class TileSums {
 public:
  explicit TileSums(JacobianKind jacobian) : jacobian_(jacobian) {}

  void accumulate(const Tile& tile, const std::vector<PlacedLevel>& placed, ReducedSystem& total);
  void addTo(const Tile& tile, const std::vector<Eigen::Matrix3d>& motions, PoseSystem& system) const;

 private:
  void reset(std::size_t submaps);
  void sampleRow(const Tile& tile, const std::vector<PlacedLevel>& placed, int b);
  void reduceCell(int column, ReducedSystem& total);
  void addNormalEquations();

  Observation& observation(std::size_t slot, int column) {
    return row_[slot * kTileColumns + static_cast<std::size_t>(column)];
  }
  Eigen::Matrix3d& block(std::size_t a, std::size_t b) { return blocks_[a * slots_ + b]; }
  const Eigen::Matrix3d& block(std::size_t a, std::size_t b) const { return blocks_[a * slots_ + b]; }

  /** What one submap brings to the cell at hand. */
  struct Term {
    std::size_t slot;
    const Observation* observation;
    double weight, residual;
    Eigen::Vector3d jacobian;
    bool flat;  ///< the row J_i is zero
  };

  JacobianKind jacobian_;
  std::size_t slots_ = 0;
  std::vector<Observation> row_;
  std::array<int, kTileColumns> seen_by_{};
  std::vector<Term> terms_;
  std::vector<Eigen::Matrix3d> blocks_;
  std::vector<Eigen::Vector3d> gradients_;
};

void TileSums::reset(std::size_t submaps) {
  slots_ = submaps;
  row_.resize(std::max(row_.size(), submaps * kTileColumns));
  terms_.reserve(submaps);
  blocks_.assign(submaps * submaps, Eigen::Matrix3d::Zero());
  gradients_.assign(submaps, Eigen::Vector3d::Zero());
}

void TileSums::accumulate(const Tile& tile, const std::vector<PlacedLevel>& placed, ReducedSystem& total) {
  reset(tile.submaps.size());
  for (int b = tile.b; b < tile.b + kTileRows; ++b) {
    sampleRow(tile, placed, b);
    for (int column = 0; column < kTileColumns; ++column)
      if (seen_by_[static_cast<std::size_t>(column)] > 1) reduceCell(column, total);
  }
}

void TileSums::sampleRow(const Tile& tile, const std::vector<PlacedLevel>& placed, int b) {
  seen_by_.fill(0);
  for (std::size_t slot = 0; slot < slots_; ++slot) {
    const PlacedLevel& submap = placed[tile.submaps[slot]];
    const EvidenceLevel& level = submap.level();
    const auto [begin, end] = submap.clip(tile.a, tile.a + kTileColumns, b);
    for (int column = 0; column < kTileColumns; ++column) observation(slot, column).value.hits = 0;
    for (int a = begin; a < end; ++a) {
      const double u = submap.columnOf(a, b), v = submap.rowOf(a, b);
      observation(slot, a - tile.a) = {level.sample(u, v), level.xOf(u), level.yOf(v)};
      seen_by_[static_cast<std::size_t>(a - tile.a)] += observation(slot, a - tile.a).value.hits > 0;
    }
  }
}

void TileSums::reduceCell(int column, ReducedSystem& total) {
  terms_.clear();
  double ww = 0, wl = 0, ll = 0, w4 = 0;
  for (std::size_t slot = 0; slot < slots_; ++slot) {
    const Observation& o = observation(slot, column);
    const double w = o.value.hits, l = o.value.log_odds;
    if (w <= 0) continue;
    terms_.push_back({slot, &o, w, 0, Eigen::Vector3d::Zero(), true});
    ww += w * w, wl += w * l, ll += l * l, w4 += w * w * w * w;
  }
  const double joint_value = wl / ww, root = 1 / std::sqrt(ww);
  bool all_flat = true;
  for (Term& term : terms_) {
    const EvidenceSample& s = term.observation->value;
    term.residual = s.log_odds - term.weight * joint_value;
    total.cost += term.residual * term.residual;
    term.weight *= root;
    const Eigen::Vector2d gradient = effectiveGradient(jacobian_, s, joint_value);
    term.flat = gradient.isZero(0);
    if (term.flat) continue;
    term.jacobian = localJacobian(gradient, term.observation->px, term.observation->py);
    all_flat = false;
  }
  total.overlap_weight += 0.5 * (ww - w4 / ww);
  total.energy += ll;
  total.observations += terms_.size();
  ++total.cells;
  if (!all_flat) addNormalEquations();
}

void TileSums::addNormalEquations() {
  for (std::size_t a = 0; a < terms_.size(); ++a) {
    const Term& i = terms_[a];
    if (i.flat) continue;
    gradients_[i.slot] += i.residual * i.jacobian;
    block(i.slot, i.slot) += ((1 - i.weight * i.weight) * i.jacobian) * i.jacobian.transpose();
    for (std::size_t b = a + 1; b < terms_.size(); ++b) {
      const Term& k = terms_[b];
      if (!k.flat) block(i.slot, k.slot) -= ((i.weight * k.weight) * i.jacobian) * k.jacobian.transpose();
    }
  }
}

void TileSums::addTo(const Tile& tile, const std::vector<Eigen::Matrix3d>& motions,
                     PoseSystem& system) const {
  for (std::size_t a = 0; a < slots_; ++a) {
    const std::size_t i = tile.submaps[a];
    system.gradient[i] += motions[i].transpose() * gradients_[a];
    for (std::size_t b = a; b < slots_; ++b) {
      const std::size_t k = tile.submaps[b];
      if (!block(a, b).isZero(0)) system.addBlock(i, k, motions[i].transpose() * block(a, b) * motions[k]);
    }
  }
}

}  // namespace

void ReducedSystem::add(const ReducedSystem& other) {
  cost += other.cost;
  overlap_weight += other.overlap_weight;
  energy += other.energy;
  observations += other.observations;
  cells += other.cells;
  system.add(other.system, 1);
}

ReducedSystem reduce(const EvidenceLevels& level, const Frames& frames, JacobianKind jacobian,
                     double lattice_angle) {
  const std::vector<PlacedLevel> placed = placeAll(level, frames, lattice_angle);
  const std::vector<Tile> tiles = overlapTiles(placed);
  std::vector<Eigen::Matrix3d> motions;
  for (const auto& frame : frames) motions.push_back(globalToLocalMotion(frame.phi));

  const std::size_t blocks = std::min(kBlocks, tiles.size());
  std::vector<ReducedSystem> sums(blocks, ReducedSystem(frames.size()));
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    TileSums tile_sums(jacobian);
    for (std::size_t t = block * tiles.size() / blocks; t < (block + 1) * tiles.size() / blocks; ++t) {
      tile_sums.accumulate(tiles[t], placed, sums[block]);
      tile_sums.addTo(tiles[t], motions, sums[block].system);
    }
  });

  ReducedSystem total(frames.size());
  for (const ReducedSystem& sum : sums) total.add(sum);
  return total;
}

}  // namespace submap_slam::grid_joining
