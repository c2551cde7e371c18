#include "uplift/math/partial_lu.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/math/dense.h"
#include "uplift/math/lanes.h"

// Right-looking elimination (G. H. Golub & C. F. Van Loan, Matrix Computations, section 3.2), panel by panel. The orders are about a
// hundred: what libraries arrange for large matrices costs more than the arithmetic.
namespace uplift {
namespace {

constexpr Index width = 8;             // of a panel
constexpr Index together = 2 * lanes;  // rows; columns are so long that whole groups of them fit

/// Row of the largest entry of a column from row `first` on, of those before `end`.
Index largest_entry(const double* column, Index first, Index end) {
  double most = -1;
  Index row = first;
  for (Index i = first; i < end; ++i)
    if (const double size = std::abs(column[i]); size > most) most = size, row = i;
  return row;
}

/// Elimination in the columns of a panel alone, from its first row `first` on.
void eliminate(double* a, Index stride, Index first, Index columns, Index n, int* swaps) {
  for (Index k = 0; k < columns; ++k) {
    const Index row = first + k;
    double* column = a + (first + k) * stride;
    const Index pivot = largest_entry(column, row, n);
    swaps[row] = static_cast<int>(pivot);
    if (pivot != row)
      for (Index j = first; j < first + columns; ++j) std::swap(a[j * stride + row], a[j * stride + pivot]);
    if (column[row] == 0) continue;  // singular, which the diagonal says
    const double inverse = 1 / column[row];
#pragma omp simd
    for (Index i = row + 1; i < n; ++i) column[i] *= inverse;
    for (Index j = first + k + 1; j < first + columns; ++j) {
      double* other = a + j * stride;
      const double factor = other[row];
#pragma omp simd
      for (Index i = row + 1; i < n; ++i) other[i] -= factor * column[i];
    }
  }
}

void exchange(double* column, Index first, Index columns, const int* swaps) {
  for (Index k = first; k < first + columns; ++k)
    if (swaps[k] != k) std::swap(column[k], column[swaps[k]]);
}

/// Some columns on the right of a whole panel: the same exchanges and elimination.
template <int count>
void follow(const double* panel, Index stride, Index first, Index n, const int* swaps, double* columns) {
  for (int c = 0; c < count; ++c) {
    double* column = columns + c * stride;
    exchange(column, first, width, swaps);
    for (Index k = 0; k + 1 < width; ++k)
      for (Index i = k + 1; i < width; ++i) column[first + i] -= panel[k * stride + first + i] * column[first + k];
  }
  for (Index row = first + width; row < n; row += together) {
    const WholeLanes upper{row}, lower{row + lanes};
    Lanes sums[2 * count];
    for (int c = 0; c < count; ++c) sums[2 * c] = upper(columns + c * stride), sums[2 * c + 1] = lower(columns + c * stride);
    for (Index k = 0; k < width; ++k) {
      const Lanes one = upper(panel + k * stride), two = lower(panel + k * stride);
      for (int c = 0; c < count; ++c) {
        const Lanes factor = columns[c * stride + first + k];
        sums[2 * c] -= factor * one;
        sums[2 * c + 1] -= factor * two;
      }
    }
    for (int c = 0; c < count; ++c) upper.put(columns + c * stride, sums[2 * c]), lower.put(columns + c * stride, sums[2 * c + 1]);
  }
}

}  // namespace

void LuInPlace::size(Index most) {
  matrix_.setZero((most + together + width - 1) / width * width, most);  // rows that are carried along, beyond those of the matrix
  swaps_.assign(static_cast<std::size_t>(most), 0);
}

bool LuInPlace::factorise(Index n) {
  order_ = n;
  if (n == 0) return true;
  const Index stride = matrix_.rows();
  double* a = matrix_.data();
  for (Index first = 0; first < n; first += width) {
    const Index columns = std::min(width, n - first);
    eliminate(a, stride, first, columns, n, swaps_.data());
    for (Index j = 0; j < first; ++j) exchange(a + j * stride, first, columns, swaps_.data());
    const double* panel = a + first * stride;
    Index j = first + columns;  // there are others only where the panel is whole
    for (; j + 4 <= n; j += 4) follow<4>(panel, stride, first, n, swaps_.data(), a + j * stride);
    for (; j < n; ++j) follow<1>(panel, stride, first, n, swaps_.data(), a + j * stride);
  }
  const auto pivots = matrix_.diagonal().head(n).cwiseAbs();
  // whatever is not finite in the matrix reaches a pivot
  return pivots.allFinite() && pivots.minCoeff() > 1e-14 * pivots.maxCoeff();
}

void LuInPlace::solve(double* x) const {
  for (Index k = 0; k < order_; ++k) std::swap(x[k], x[swaps_[static_cast<std::size_t>(k)]]);
  Map solution(x, order_);
  const auto part = matrix_.topLeftCorner(order_, order_);
  part.triangularView<Eigen::UnitLower>().solveInPlace(solution);
  part.triangularView<upper_triangle>().solveInPlace(solution);
}

}  // namespace uplift
