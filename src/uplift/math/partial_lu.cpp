#include "uplift/math/partial_lu.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/math/dense.h"
#include "uplift/math/lanes.h"

// Right-looking elimination (G. H. Golub & C. F. Van Loan, Matrix Computations, section 3.2), panel by panel. Most orders are about a
// hundred: what libraries arrange for large matrices costs more than the arithmetic. Panels alone would read a matrix that the caches do
// not hold order / width times; beyond order `large` they stay within blocks of columns, and products of matrices do the rest.
namespace uplift {
namespace {

constexpr Index width = 8;                // of a panel
constexpr Index large = 512, wide = 128;  // order from which blocks pay, their columns (docs/performance.md); multiples of the width
constexpr Index together = 2 * lanes;     // rows; columns are so long that whole groups of them fit

/// Row of the largest entry of a column from row `first` on, of those before `end`.
Index largest_entry(const double* column, Index first, Index end) {
  double most = 0;
#pragma omp simd reduction(max : most)
  for (Index i = first; i < end; ++i) most = larger(most, absolute(column[i]));
  Index row = first;
  while (row < end && absolute(column[row]) < most) ++row;
  return row < end ? row : first;
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

/// The inverse of the unit lower triangle of a panel: its columns one after another.
void invert_triangle(const double* panel, Index stride, Index first, double* inverse) {
  for (Index j = 0; j < width; ++j) {
    double* x = inverse + j * width;
    std::fill_n(x, width, 0.0);
    x[j] = 1;
    for (Index k = j; k + 1 < width; ++k)
      for (Index i = k + 1; i < width; ++i) x[i] -= panel[k * stride + first + i] * x[k];
  }
}

/// Some columns on the right of a whole panel: the same exchanges and elimination. `inverse`: of its triangle.
template <int count>
void follow(const double* panel, const double* inverse, Index stride, Index first, Index n, const int* swaps, double* columns) {
  for (int c = 0; c < count; ++c) {
    double* column = columns + c * stride;
    exchange(column, first, width, swaps);
    double top[width] = {};
    for (Index k = 0; k < width; ++k)
#pragma omp simd
      for (Index i = 0; i < width; ++i) top[i] += inverse[k * width + i] * column[first + k];
    std::copy_n(top, width, column + first);
  }
  for (Index row = first + width; row < n; row += together) {
    const WholeLanes upper{row}, lower{row + lanes};
    Lanes high[count], low[count];  // in registers
#pragma GCC unroll 8
    for (int c = 0; c < count; ++c) high[c] = upper(columns + c * stride), low[c] = lower(columns + c * stride);
#pragma GCC unroll 8
    for (Index k = 0; k < width; ++k) {
      const Lanes one = upper(panel + k * stride), two = lower(panel + k * stride);
#pragma GCC unroll 8
      for (int c = 0; c < count; ++c) {
        const Lanes factor = columns[c * stride + first + k];
        high[c] -= factor * one;
        low[c] -= factor * two;
      }
    }
#pragma GCC unroll 8
    for (int c = 0; c < count; ++c) upper.put(columns + c * stride, high[c]), lower.put(columns + c * stride, low[c]);
  }
}

}  // namespace

void LuInPlace::size(Index most) {
  matrix_.resize((most + together + width - 1) / width * width, most);  // rows that are carried along, beyond those of the matrix
  swaps_.assign(static_cast<std::size_t>(most), 0);
}

/// Columns from `from` to `end`, all rows below: panels, which leave the columns on the right as they are.
void LuInPlace::factorise_block(Index from, Index end) {
  const Index n = order_, stride = matrix_.rows();
  double* a = matrix_.data();
  for (Index first = from; first < end; first += width) {
    const Index columns = std::min(width, end - first);
    eliminate(a, stride, first, columns, n, swaps_.data());
    for (Index j = 0; j < first; ++j) exchange(a + j * stride, first, columns, swaps_.data());
    Index j = first + columns;
    if (j == end) break;  // else the panel is whole
    const double* panel = a + first * stride;
    double inverse[width * width];
    invert_triangle(panel, stride, first, inverse);
    for (; j + 4 <= end; j += 4) follow<4>(panel, inverse, stride, first, n, swaps_.data(), a + j * stride);
    for (; j < end; ++j) follow<1>(panel, inverse, stride, first, n, swaps_.data(), a + j * stride);
  }
}

/// Everything on the right of a block.
void LuInPlace::follow_block(Index from, Index end) {
  const Index columns = end - from, rest = order_ - end;
  for (Index j = end; j < order_; ++j) exchange(column(j), from, columns, swaps_.data());
  auto top = matrix_.block(from, end, columns, rest);
  matrix_.block(from, from, columns, columns).triangularView<Eigen::UnitLower>().solveInPlace(top);
  matrix_.block(end, end, rest, rest).noalias() -= matrix_.block(end, from, rest, columns) * top;
}

bool LuInPlace::factorise(Index n) {
  order_ = n;
  if (n == 0) return true;
  for (Index j = 0; j < n; ++j) std::fill_n(column(j) + n, together, 0.0);  // carried along: they would grow from one matrix to the next
  const Index block = n > large ? wide : n;
  for (Index from = 0; from < n; from += block) {
    const Index end = std::min(from + block, n);
    factorise_block(from, end);
    if (end < n) follow_block(from, end);
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

void LuInPlace::solve(Matrix& x) const {
  for (Index k = 0; k < order_; ++k)
    if (const Index pivot = swaps_[static_cast<std::size_t>(k)]; pivot != k) x.row(k).swap(x.row(pivot));
  const auto part = matrix_.topLeftCorner(order_, order_);
  part.triangularView<Eigen::UnitLower>().solveInPlace(x);
  part.triangularView<upper_triangle>().solveInPlace(x);
}

}  // namespace uplift
