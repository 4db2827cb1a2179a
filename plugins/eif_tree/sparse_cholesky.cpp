#include "sparse_cholesky.h"

#include <stdexcept>

namespace submap_slam::landmark_joining {
namespace {

/** The matrix as CHOLMOD sees it; nothing is copied. */
cholmod_sparse viewOf(Eigen::SparseMatrix<double>& lower) {
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(lower.rows());
  view.nzmax = static_cast<std::size_t>(lower.nonZeros());
  view.p = lower.outerIndexPtr();
  view.i = lower.innerIndexPtr();
  view.x = lower.valuePtr();
  view.stype = -1;
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
  common_.postorder = 1;
  cholmod_sparse view = viewOf(pattern);
  factor_ = cholmod_analyze(&view, &common_);
  if (factor_ != nullptr) return;
  cholmod_finish(&common_);
  throw std::runtime_error("CHOLMOD cannot analyse the pattern of the information matrix");
}

SparseCholesky::~SparseCholesky() {
  cholmod_free_factor(&factor_, &common_);
  cholmod_finish(&common_);
}

bool SparseCholesky::factorize(Eigen::SparseMatrix<double>& lower) {
  cholmod_sparse view = viewOf(lower);
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
