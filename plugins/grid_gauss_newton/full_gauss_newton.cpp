#include "full_gauss_newton.h"

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <cmath>
#include <vector>

namespace submap_slam::grid_joining {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

struct Observation {
  std::size_t submap;
  std::size_t cell;
  EvidenceSample value;
  double px, py;
};

/** Half-open bounds on the lattice. */
struct Bounds {
  int a_min = 0, a_max = 0, b_min = 0, b_max = 0;
};

Bounds boundsOf(const std::vector<PlacedLevel>& placed) {
  Bounds all;
  for (const PlacedLevel& submap : placed)
    for (const auto& block : submap.level().blocks())
      for (const int u : {block.column, block.column + EvidenceLevel::kBlock})
        for (const int v : {block.row, block.row + EvidenceLevel::kBlock}) {
          const double a = submap.aOf(u, v), b = submap.bOf(u, v);
          all = {std::min(all.a_min, static_cast<int>(std::floor(a))),
                 std::max(all.a_max, static_cast<int>(std::ceil(a)) + 1),
                 std::min(all.b_min, static_cast<int>(std::floor(b))),
                 std::max(all.b_max, static_cast<int>(std::ceil(b)) + 1)};
        }
  return all;
}

/** One observation for each submap and lattice point where it has evidence. */
std::vector<Observation> observationsOf(const std::vector<PlacedLevel>& placed, std::size_t& cells) {
  const Bounds all = boundsOf(placed);
  std::vector<Observation> rows;
  cells = 0;
  for (int b = all.b_min; b < all.b_max; ++b)
    for (int a = all.a_min; a < all.a_max; ++a) {
      const std::size_t first = rows.size();
      for (std::size_t i = 0; i < placed.size(); ++i) {
        const EvidenceLevel& level = placed[i].level();
        const double u = placed[i].columnOf(a, b), v = placed[i].rowOf(a, b);
        const EvidenceSample sample = level.sample(u, v);
        if (sample.hits > 0) rows.push_back({i, cells, sample, level.xOf(u), level.yOf(v)});
      }
      if (rows.size() > first) ++cells;
    }
  return rows;
}

/** Σ over the rows of each cell of a function of the row. */
template <class Function>
std::vector<double> sumPerCell(const std::vector<Observation>& rows, std::size_t cells, Function value) {
  std::vector<double> sums(cells, 0);
  for (const Observation& row : rows) sums[row.cell] += value(row.value);
  return sums;
}

/** Column of each unknown of the frames after leaving out the held frames; -1 for those. */
std::vector<int> columnsOf(const std::vector<bool>& held, int& free) {
  std::vector<int> columns(3 * held.size(), -1);
  free = 0;
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (!held[k / 3]) columns[k] = free++;
  return columns;
}

SparseMatrix selection(const std::vector<int>& columns, int free) {
  SparseMatrix matrix(static_cast<Eigen::Index>(columns.size()), free);
  Triplets entries;
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k] >= 0) entries.emplace_back(static_cast<int>(k), columns[k], 1.0);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/** [A B; C D] */
SparseMatrix stacked(const SparseMatrix& a, const SparseMatrix& b, const SparseMatrix& d) {
  Triplets entries;
  const auto put = [&entries](const SparseMatrix& m, Eigen::Index row, Eigen::Index column, bool transposed) {
    for (int k = 0; k < m.outerSize(); ++k)
      for (SparseMatrix::InnerIterator it(m, k); it; ++it) {
        const Eigen::Index r = transposed ? it.col() : it.row(), c = transposed ? it.row() : it.col();
        entries.emplace_back(static_cast<int>(row + r), static_cast<int>(column + c), it.value());
      }
  };
  put(a, 0, 0, false);
  put(b, 0, a.cols(), false);
  put(b, a.rows(), 0, true);
  put(d, a.rows(), a.cols(), false);
  SparseMatrix matrix(a.rows() + d.rows(), a.cols() + d.cols());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/** The rows ∂L/∂X of the free frames only, and what the pose terms add for them. */
struct FreeProblem {
  FreeProblem(const ExplicitProblem& problem, const PoseSystem& pose_terms, const std::vector<bool>& held) {
    int free = 0;
    const auto columns = columnsOf(held, free);
    select = selection(columns, free);
    jacobian = problem.pose_jacobian * select;
    added_matrix = select.transpose() * pose_terms.sparseMatrix() * select;
    added_gradient = select.transpose() * pose_terms.denseGradient();
  }
  SparseMatrix select, jacobian, added_matrix;
  Eigen::VectorXd added_gradient;
};

std::optional<Eigen::VectorXd> choleskySolve(const SparseMatrix& matrix, const Eigen::VectorXd& right) {
  Eigen::CholmodDecomposition<SparseMatrix, Eigen::Lower> cholesky;
  cholesky.cholmod().print = 0;
  cholesky.compute(matrix);
  if (cholesky.info() != Eigen::Success) return std::nullopt;
  const Eigen::VectorXd solution = cholesky.solve(right);
  if (cholesky.info() != Eigen::Success || !solution.allFinite()) return std::nullopt;
  return solution;
}

}  // namespace

ExplicitProblem writeOut(const EvidenceLevels& level, const Frames& frames, JacobianKind jacobian,
                         double lattice_angle) {
  std::size_t cells = 0;
  const std::vector<Observation> rows =
      observationsOf(PlacedLevels(level, frames, lattice_angle).submaps, cells);
  const auto n = sumPerCell(rows, cells, [](const EvidenceSample& s) { return s.hits; });
  const auto ww = sumPerCell(rows, cells, [](const EvidenceSample& s) { return s.hits * s.hits; });
  const auto wl = sumPerCell(rows, cells, [](const EvidenceSample& s) { return s.hits * s.log_odds; });

  const auto count = static_cast<Eigen::Index>(rows.size());
  ExplicitProblem problem;
  problem.values.resize(count);
  Triplets pose_entries, map_entries;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Observation& row = rows[static_cast<std::size_t>(k)];
    problem.values[k] = row.value.log_odds;
    map_entries.emplace_back(k, row.cell, row.value.hits / n[row.cell]);
    const auto gradient = effectiveGradient(jacobian, row.value, wl[row.cell] / ww[row.cell]);
    const Eigen::Vector3d j =
        globalToLocalMotion(frames[row.submap].phi).transpose() * localJacobian(gradient, row.px, row.py);
    for (int d = 0; d < 3; ++d) pose_entries.emplace_back(k, 3 * static_cast<int>(row.submap) + d, j[d]);
  }
  problem.pose_jacobian.resize(count, 3 * static_cast<Eigen::Index>(frames.size()));
  problem.pose_jacobian.setFromTriplets(pose_entries.begin(), pose_entries.end());
  problem.map_jacobian.resize(count, static_cast<Eigen::Index>(cells));
  problem.map_jacobian.setFromTriplets(map_entries.begin(), map_entries.end());
  return problem;
}

std::optional<FullStep> fullStep(const ExplicitProblem& problem, const Eigen::VectorXd& map,
                                 const PoseSystem& pose_terms, const std::vector<bool>& held) {
  const FreeProblem p(problem, pose_terms, held);
  const SparseMatrix& j_map = problem.map_jacobian;
  const SparseMatrix u = p.jacobian.transpose() * p.jacobian;
  const SparseMatrix w = -p.jacobian.transpose() * j_map;
  const SparseMatrix v = j_map.transpose() * j_map;
  const Eigen::VectorXd residual = j_map * map - problem.values;

  Eigen::VectorXd right(u.rows() + v.rows());
  right << p.jacobian.transpose() * residual - p.added_gradient, -(j_map.transpose() * residual);
  const auto solution = choleskySolve(stacked(u + p.added_matrix, w, v), right);
  if (!solution) return std::nullopt;
  return FullStep{p.select * solution->head(u.rows()), solution->tail(v.rows())};
}

std::optional<Eigen::VectorXd> poseOnlyStep(const ExplicitProblem& problem, const PoseSystem& pose_terms,
                                            const std::vector<bool>& held) {
  const FreeProblem p(problem, pose_terms, held);
  const SparseMatrix& j_map = problem.map_jacobian;
  const SparseMatrix v = j_map.transpose() * j_map;
  const Eigen::VectorXd v_inverse = v.diagonal().cwiseInverse();
  const SparseMatrix w = p.jacobian.transpose() * j_map;
  const SparseMatrix w_v_inverse = w * v_inverse.asDiagonal();
  const SparseMatrix u = p.jacobian.transpose() * p.jacobian;
  const SparseMatrix schur = u - SparseMatrix(w_v_inverse * w.transpose());
  const Eigen::VectorXd gradient =
      p.jacobian.transpose() * problem.values - w_v_inverse * (j_map.transpose() * problem.values);
  const auto step = choleskySolve(schur + p.added_matrix, -gradient - p.added_gradient);
  if (!step) return std::nullopt;
  return Eigen::VectorXd(p.select * *step);
}

}  // namespace submap_slam::grid_joining
