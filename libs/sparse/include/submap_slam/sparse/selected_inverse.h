#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace submap_slam {

/** Cholesky factor of a symmetric matrix A with reordered rows: P A Pᵀ = L D Lᵀ, L with a diagonal of ones.
 */
struct SparseFactor {
  Eigen::SparseMatrix<double> lower;  ///< strictly lower triangle of L, rows of each column ascending
  Eigen::VectorXd diagonal;           ///< of D
  Eigen::VectorXi position;           ///< row of L for each row of A
};

/** The entries of A⁻¹ where L has some, from the last column to the first by Takahashi's equations: it costs
 * about as much as the factorization, and no other entry of the inverse is computed. Among them are all
 * entries where A itself has some. */
class SelectedInverse {
 public:
  explicit SelectedInverse(SparseFactor factor);

  /** Entry of A⁻¹; L must have an entry there. */
  double at(int row, int column) const;

 private:
  void findColumn(int column);
  int entryAt(int row, int column, int from) const;

  SparseFactor factor_;
  std::vector<double> diagonal_, below_;  // `below_` has the entries of L
  std::vector<double> sum_;               // of the column at work
};

}  // namespace submap_slam
