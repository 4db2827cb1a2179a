#include <submap_slam/sparse/selected_inverse.h>

#include <algorithm>
#include <utility>

namespace submap_slam {
namespace {

template <class Values>
auto& element(Values& values, int i) {
  return values[static_cast<std::size_t>(i)];
}

}  // namespace

SelectedInverse::SelectedInverse(SparseFactor factor) : factor_(std::move(factor)) {
  const auto n = static_cast<std::size_t>(factor_.lower.cols());
  diagonal_.resize(n), sum_.resize(n);
  below_.resize(static_cast<std::size_t>(factor_.lower.nonZeros()));
  for (int column = static_cast<int>(n) - 1; column >= 0; --column) findColumn(column);
}

/** Z_ij = −Σ_k Z_ik L_kj and Z_jj = 1/D_j − Σ_k Z_kj L_kj; all Z_ik that it asks for are entries of L. */
void SelectedInverse::findColumn(int column) {
  const int *row = factor_.lower.innerIndexPtr(), *start = factor_.lower.outerIndexPtr();
  const double* value = factor_.lower.valuePtr();
  const int begin = start[column], end = start[column + 1];
  for (int e = begin; e < end; ++e) element(sum_, row[e]) = 0;
  for (int e = begin; e < end; ++e) {
    const int k = row[e];
    double sum = element(sum_, k) + element(diagonal_, k) * value[e];
    for (int e2 = e + 1, f = start[k]; e2 < end; ++e2, ++f) {
      f = entryAt(row[e2], k, f);
      element(sum_, row[e2]) += element(below_, f) * value[e];
      sum += element(below_, f) * value[e2];
    }
    element(sum_, k) = sum;
  }
  element(diagonal_, column) = 1 / factor_.diagonal[column];
  for (int e = begin; e < end; ++e) {
    element(below_, e) = -element(sum_, row[e]);
    element(diagonal_, column) -= element(below_, e) * value[e];
  }
}

/** Index of an entry of L at or behind `from`. Rows often follow each other without a gap. */
int SelectedInverse::entryAt(int row, int column, int from) const {
  const int *rows = factor_.lower.innerIndexPtr(), *start = factor_.lower.outerIndexPtr();
  const int end = start[column + 1], guess = from + (row - rows[from]);
  if (guess < end && rows[guess] == row) return guess;
  return static_cast<int>(std::lower_bound(rows + from, rows + end, row) - rows);
}

double SelectedInverse::at(int row, int column) const {
  const int a = factor_.position[row], b = factor_.position[column];
  const int low = std::max(a, b), left = std::min(a, b);
  if (low == left) return element(diagonal_, low);
  return element(below_, entryAt(low, left, factor_.lower.outerIndexPtr()[left]));
}

}  // namespace submap_slam
