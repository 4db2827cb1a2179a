#pragma once

#include <cholmod.h>
#include <submap_slam/sparse/selected_inverse.h>

#include <Eigen/SparseCore>
#include <vector>

namespace submap_slam::landmark_joining {

/** Columns W = D^−½ L⁻¹ E, by which A⁻¹ = Wᵀ W for A = L D Lᵀ. A column is not zero on the path from its row
 * to the root of the elimination tree alone; only the rows on the paths are held. */
struct HalfInverse {
  std::vector<int> at;  ///< the rows held, in the order of elimination, ascending
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values;
};

/** The block of A⁻¹ in the rows of a and the columns of b. */
Eigen::MatrixXd inverseBetween(const HalfInverse& a, const HalfInverse& b);

/** Cholesky factor of a sparse symmetric matrix by CHOLMOD, column by column ("simplicial"): its bits depend
 * neither on a BLAS library nor on threads. The rows come in a good order already; the symbolic analysis is
 * done once and serves every matrix with the same pattern. */
class SparseCholesky {
 public:
  /** @param pattern upper triangle; values do not matter */
  explicit SparseCholesky(Eigen::SparseMatrix<double>& pattern);
  ~SparseCholesky();
  SparseCholesky(const SparseCholesky&) = delete;
  SparseCholesky& operator=(const SparseCholesky&) = delete;

  /** False if the matrix is not positive definite. */
  bool factorize(Eigen::SparseMatrix<double>& upper);

  /** A⁻¹ B; after factorize() only. */
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b);

  /** D^−½ L⁻¹ E, E the columns of these rows of the unit matrix, with A = L D Lᵀ; after factorize() only. */
  HalfInverse halfInverse(const std::vector<int>& rows) const;

  /** After factorize() only. */
  SparseFactor factor() const;

 private:
  std::vector<int> pathsToRoot(const std::vector<int>& columns) const;

  cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
  std::vector<int> position_;  // of each row of A in the factor
};

}  // namespace submap_slam::landmark_joining
