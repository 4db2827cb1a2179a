#include "pose_system.h"

#include <mrpt/math/wrap2pi.h>
#include <submap_slam/sparse/selected_inverse.h>

#include <Eigen/Sparse>
#include <algorithm>
#include <numeric>

namespace submap_slam::grid_joining {
namespace {

using Factorization = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower>;

Eigen::Index row(std::size_t frame) { return 3 * static_cast<Eigen::Index>(frame); }

/** First row of each frame in the system without the held ones; -1 for those. */
std::vector<int> freeRows(const std::vector<bool>& held, int& size) {
  std::vector<int> rows(held.size(), -1);
  size = 0;
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (held[i]) continue;
    rows[i] = size;
    size += 3;
  }
  return rows;
}

Eigen::SparseMatrix<double> lowerTriangle(const PoseSystem& system, const std::vector<int>& rows, int size,
                                          const Eigen::VectorXd& added) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(9 * system.blocks.size() + static_cast<std::size_t>(added.size()));
  for (const auto& [pair, block] : system.blocks) {
    const int a = rows[pair.first], b = rows[pair.second];
    if (a < 0 || b < 0) continue;
    for (int c = 0; c < 3; ++c)
      for (int d = 0; d < 3; ++d)
        if (b + d >= a + c) entries.emplace_back(b + d, a + c, block(c, d));
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (int c = 0; c < 3 && rows[i] >= 0; ++c)
      entries.emplace_back(rows[i] + c, rows[i] + c, added[row(i) + c]);
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

bool factorize(const Eigen::SparseMatrix<double>& matrix, Factorization& factorization) {
  factorization.compute(matrix);
  return factorization.info() == Eigen::Success && factorization.vectorD().minCoeff() > 0;
}

SparseFactor factorOf(const Factorization& factorization) {
  return {factorization.matrixL().nestedExpression(), factorization.vectorD(),
          factorization.permutationP().indices()};
}

}  // namespace

void PoseSystem::addBlock(std::size_t i, std::size_t k, const Eigen::Matrix3d& block) {
  Eigen::Matrix3d& stored = blocks.try_emplace(std::minmax(i, k), Eigen::Matrix3d::Zero()).first->second;
  if (i == k)
    stored += 0.5 * (block + block.transpose());  // symmetric to the last bit
  else if (i < k)
    stored += block;
  else
    stored += block.transpose();
}

void PoseSystem::add(const PoseSystem& other, double scale) {
  for (std::size_t i = 0; i < gradient.size(); ++i) gradient[i] += scale * other.gradient[i];
  for (const auto& [pair, block] : other.blocks) addBlock(pair.first, pair.second, scale * block);
}

Eigen::MatrixXd PoseSystem::denseMatrix() const {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(row(frames()), row(frames()));
  for (const auto& [pair, block] : blocks) {
    matrix.block<3, 3>(row(pair.first), row(pair.second)) = block;
    matrix.block<3, 3>(row(pair.second), row(pair.first)) = block.transpose();
  }
  return matrix;
}

Eigen::SparseMatrix<double> PoseSystem::sparseMatrix() const {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(18 * blocks.size());
  for (const auto& [pair, block] : blocks)
    for (int c = 0; c < 3; ++c)
      for (int d = 0; d < 3; ++d) {
        const auto r = static_cast<int>(row(pair.first)) + c, k = static_cast<int>(row(pair.second)) + d;
        entries.emplace_back(r, k, block(c, d));
        if (pair.first != pair.second) entries.emplace_back(k, r, block(c, d));
      }
  Eigen::SparseMatrix<double> matrix(row(frames()), row(frames()));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Eigen::VectorXd PoseSystem::denseGradient() const {
  Eigen::VectorXd g(row(frames()));
  for (std::size_t i = 0; i < frames(); ++i) g.segment<3>(row(i)) = gradient[i];
  return g;
}

std::vector<std::size_t> groupsOf(const PoseSystem& system) {
  std::vector<std::size_t> group(system.frames());
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto root = [&group](std::size_t i) {
    for (; group[i] != i; i = group[i]) group[i] = group[group[i]];  // halves the way for the next one
    return i;
  };
  for (const auto& [pair, block] : system.blocks) {
    if (pair.first == pair.second || block.isZero(0)) continue;
    const std::size_t a = root(pair.first), b = root(pair.second);
    group[std::max(a, b)] = std::min(a, b);
  }
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = root(i);
  return group;
}

std::vector<bool> anchorsOf(const PoseSystem& system) {
  const std::vector<std::size_t> group = groupsOf(system);
  std::vector<bool> held(group.size());
  for (std::size_t i = 0; i < held.size(); ++i) held[i] = group[i] == i;
  return held;
}

Eigen::VectorXd dampingDiagonal(const PoseSystem& system, double damping) {
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(row(system.frames()));
  for (const auto& [pair, block] : system.blocks)
    if (pair.first == pair.second) diagonal.segment<3>(row(pair.first)) = block.diagonal();
  const double trace_of_it = 1e-12 * std::max(diagonal.maxCoeff(), 1e-300);
  return damping * diagonal.cwiseMax(trace_of_it).array() + trace_of_it;
}

std::optional<Eigen::VectorXd> solve(const PoseSystem& system, const std::vector<bool>& held,
                                     const Eigen::VectorXd& added) {
  int size = 0;
  const std::vector<int> rows = freeRows(held, size);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(row(system.frames()));
  if (size == 0) return step;
  Factorization factorization;
  if (!factorize(lowerTriangle(system, rows, size, added), factorization)) return std::nullopt;

  Eigen::VectorXd right(size);
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i] >= 0) right.segment<3>(rows[i]) = -system.gradient[i];
  const Eigen::VectorXd solution = factorization.solve(right);
  if (!solution.allFinite()) return std::nullopt;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i] >= 0) step.segment<3>(row(i)) = solution.segment<3>(rows[i]);
  return step;
}

std::optional<std::vector<Eigen::Matrix3d>> marginalCovariances(const PoseSystem& system,
                                                                const std::vector<bool>& held,
                                                                const Eigen::VectorXd& added) {
  int size = 0;
  const std::vector<int> rows = freeRows(held, size);
  std::vector<Eigen::Matrix3d> covariances(system.frames(), Eigen::Matrix3d::Zero());
  if (size == 0) return covariances;
  Factorization factorization;
  if (!factorize(lowerTriangle(system, rows, size, added), factorization)) return std::nullopt;

  const SelectedInverse inverse(factorOf(factorization));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (int c = 0; c < 3 && rows[i] >= 0; ++c)
      for (int d = 0; d < 3; ++d) covariances[i](c, d) = inverse.at(rows[i] + c, rows[i] + d);
  return covariances;
}

Frames moved(const Frames& frames, const Eigen::VectorXd& step) {
  Frames result = frames;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    result[i].x += step[row(i)];
    result[i].y += step[row(i) + 1];
    if (step[row(i) + 2] != 0) result[i].phi = mrpt::math::wrapToPi(result[i].phi + step[row(i) + 2]);
  }
  return result;
}

}  // namespace submap_slam::grid_joining
