#include "sparse_cholesky.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace submap_slam::landmark_joining {
namespace {

/** The matrix as CHOLMOD sees it; nothing is copied. */
cholmod_sparse viewOf(Eigen::SparseMatrix<double>& upper) {
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(upper.rows());
  view.nzmax = static_cast<std::size_t>(upper.nonZeros());
  view.p = upper.outerIndexPtr();
  view.i = upper.innerIndexPtr();
  view.x = upper.valuePtr();
  view.stype = 1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;
  return view;
}

}  // namespace

SparseCholesky::SparseCholesky(Eigen::SparseMatrix<double>& pattern) {
  cholmod_start(&common_);
  common_.print = 0;
  common_.supernodal = CHOLMOD_SIMPLICIAL;
  common_.nmethods = 1;
  common_.method[0].ordering = CHOLMOD_NATURAL;
  common_.postorder = 0;  // AMD did that; a matrix in the order of elimination need not be transposed
  cholmod_sparse view = viewOf(pattern);
  factor_ = cholmod_analyze(&view, &common_);
  if (factor_ == nullptr) {
    cholmod_finish(&common_);
    throw std::runtime_error("CHOLMOD cannot analyse the pattern of the information matrix");
  }
  const auto* order = static_cast<const int*>(factor_->Perm);
  position_.resize(factor_->n);
  for (std::size_t column = 0; column < factor_->n; ++column)
    position_[static_cast<std::size_t>(order[column])] = static_cast<int>(column);
}

SparseCholesky::~SparseCholesky() {
  cholmod_free_factor(&factor_, &common_);
  cholmod_finish(&common_);
}

bool SparseCholesky::factorize(Eigen::SparseMatrix<double>& upper) {
  cholmod_sparse view = viewOf(upper);
  common_.final_ll = 0;
  if (cholmod_factorize(&view, factor_, &common_) == 0 || common_.status != CHOLMOD_OK) return false;
  // L D Lᵀ exists for many indefinite matrices too.
  const auto* start = static_cast<const int*>(factor_->p);
  const auto* value = static_cast<const double*>(factor_->x);
  for (std::size_t column = 0; column < factor_->n; ++column)
    if (!(value[start[column]] > 0)) return false;
  return true;
}

Eigen::MatrixXd SparseCholesky::solve(const Eigen::MatrixXd& b) {
  cholmod_dense view{};
  view.nrow = view.d = static_cast<std::size_t>(b.rows());
  view.ncol = static_cast<std::size_t>(b.cols());
  view.nzmax = static_cast<std::size_t>(b.size());
  view.x = const_cast<double*>(b.data());
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor_, &view, &common_);
  if (solution == nullptr) throw std::runtime_error("CHOLMOD cannot solve the information form");
  Eigen::MatrixXd x = Eigen::Map<Eigen::MatrixXd>(static_cast<double*>(solution->x), b.rows(), b.cols());
  cholmod_free_dense(&solution, &common_);
  return x;
}

/** The columns and all that follow them in the elimination tree, ascending. */
std::vector<int> SparseCholesky::pathsToRoot(const std::vector<int>& columns) const {
  const auto *start = static_cast<const int*>(factor_->p), *count = static_cast<const int*>(factor_->nz),
             *row = static_cast<const int*>(factor_->i);
  std::vector<bool> met(factor_->n);
  std::vector<int> path;
  for (int column : columns)
    while (!met[static_cast<std::size_t>(column)]) {
      met[static_cast<std::size_t>(column)] = true;
      path.push_back(column);
      if (count[column] > 1) column = row[start[column] + 1];  // the first row below the diagonal
    }
  std::sort(path.begin(), path.end());
  return path;
}

HalfInverse SparseCholesky::halfInverse(const std::vector<int>& rows) const {
  const auto *start = static_cast<const int*>(factor_->p), *count = static_cast<const int*>(factor_->nz),
             *row = static_cast<const int*>(factor_->i);
  const auto* value = static_cast<const double*>(factor_->x);
  std::vector<int> columns;
  columns.reserve(rows.size());
  for (const int r : rows) columns.push_back(position_[static_cast<std::size_t>(r)]);
  HalfInverse half;
  half.at = pathsToRoot(columns);
  std::vector<Eigen::Index> held(factor_->n);
  for (std::size_t k = 0; k < half.at.size(); ++k)
    held[static_cast<std::size_t>(half.at[k])] = static_cast<Eigen::Index>(k);
  auto& w = half.values;
  w.setZero(static_cast<Eigen::Index>(half.at.size()), static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < columns.size(); ++i)
    w(held[static_cast<std::size_t>(columns[i])], static_cast<Eigen::Index>(i)) = 1;
  for (Eigen::Index k = 0; k < w.rows(); ++k) {
    const int column = half.at[static_cast<std::size_t>(k)];
    for (int e = start[column] + 1; e < start[column] + count[column]; ++e)
      w.row(held[static_cast<std::size_t>(row[e])]) -= value[e] * w.row(k);
    w.row(k) /= std::sqrt(value[start[column]]);
  }
  return half;
}

Eigen::MatrixXd inverseBetween(const HalfInverse& a, const HalfInverse& b) {
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(a.values.cols(), b.values.cols());
  for (std::size_t i = 0, k = 0; i < a.at.size() && k < b.at.size();) {
    if (a.at[i] == b.at[k])
      block.noalias() +=
          a.values.row(static_cast<Eigen::Index>(i)).transpose() * b.values.row(static_cast<Eigen::Index>(k));
    const int at_a = a.at[i], at_b = b.at[k];
    if (at_a <= at_b) ++i;
    if (at_b <= at_a) ++k;
  }
  return block;
}

SparseFactor SparseCholesky::factor() const {
  const auto n = static_cast<int>(factor_->n);
  const auto *start = static_cast<const int*>(factor_->p), *count = static_cast<const int*>(factor_->nz),
             *row = static_cast<const int*>(factor_->i), *order = static_cast<const int*>(factor_->Perm);
  const auto* value = static_cast<const double*>(factor_->x);
  SparseFactor f;
  f.diagonal.resize(n), f.position.resize(n), f.lower.resize(n, n);
  int entries = 0;
  for (int column = 0; column < n; ++column) entries += count[column] - 1;
  f.lower.resizeNonZeros(entries);
  for (int column = 0, entry = 0; column < n; ++column) {
    f.position[order[column]] = column;
    f.diagonal[column] = value[start[column]];
    f.lower.outerIndexPtr()[column] = entry;
    for (int e = start[column] + 1; e < start[column] + count[column]; ++e, ++entry) {
      f.lower.innerIndexPtr()[entry] = row[e];
      f.lower.valuePtr()[entry] = value[e];
    }
  }
  f.lower.outerIndexPtr()[n] = entries;
  return f;
}

}  // namespace submap_slam::landmark_joining
