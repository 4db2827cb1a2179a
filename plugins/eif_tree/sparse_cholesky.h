#pragma once

#include <cholmod.h>
#include <submap_slam/sparse/selected_inverse.h>

#include <Eigen/SparseCore>

namespace submap_slam::landmark_joining {

/** Cholesky factor of a sparse symmetric matrix by CHOLMOD, column by column ("simplicial"): its bits depend
 * neither on a BLAS library nor on threads. The rows come in a good order already; the symbolic analysis is
 * done once and serves every matrix with the same pattern. */
class SparseCholesky {
 public:
  /** @param pattern lower triangle; values do not matter */
  explicit SparseCholesky(Eigen::SparseMatrix<double>& pattern);
  ~SparseCholesky();
  SparseCholesky(const SparseCholesky&) = delete;
  SparseCholesky& operator=(const SparseCholesky&) = delete;

  /** False if the matrix is not positive definite. */
  bool factorize(Eigen::SparseMatrix<double>& lower);

  /** A⁻¹ B; after factorize() only. */
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b);

  /** After factorize() only. */
  SparseFactor factor() const;

 private:
  cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
};

}  // namespace submap_slam::landmark_joining
