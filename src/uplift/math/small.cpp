#include "uplift/math/small.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace uplift::small {

void multiply_any(const Matrix& a, const double* x, double* y) {
  const double* column = a.data();
  std::fill_n(y, a.rows(), 0.0);
  for (std::ptrdiff_t j = 0; j < a.cols(); ++j, column += a.rows()) add(a.rows(), x[j], column, y);
}

namespace {

template <int columns>
[[gnu::noinline]] void affine_of(const Matrix& a, const double* b, const double* x, double* y, double factor) {
  const double* column = a.data();
  double scaled[columns];
  for (int j = 0; j < columns; ++j) scaled[j] = factor * x[j];
  with_size(a.rows(), [=](auto n) {
#pragma omp simd
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      double sum = b[i];
      for (int j = 0; j < columns; ++j) sum += column[j * n + i] * scaled[j];
      y[i] = sum;
    }
  });
}

[[gnu::noinline]] void affine_of_many(const Matrix& a, const double* b, const double* x, double* y, double factor) {
  if (y != b) std::copy_n(b, a.rows(), y);
  for (std::ptrdiff_t j = 0; j < a.cols(); ++j) add(a.rows(), factor * x[j], a.data() + j * a.rows(), y);
}

}  // namespace

void affine(const Matrix& a, const double* b, const double* x, double* y, double factor) {
  switch (a.cols()) {
    case 1:
      return affine_of<1>(a, b, x, y, factor);
    case 2:
      return affine_of<2>(a, b, x, y, factor);
    case 3:
      return affine_of<3>(a, b, x, y, factor);
    default:
      return affine_of_many(a, b, x, y, factor);
  }
}

namespace {

/// What the columns from `first` on add to y = A x by their entries on and above the diagonal: a number is read once and used for its row
/// and for its column.
template <int columns>
void add_symmetric_columns(const Matrix& a, std::ptrdiff_t first, const double* x, double* y) {
  const double* column[columns];
  Lanes factor[columns], sums[columns];
  for (int k = 0; k < columns; ++k) {
    column[k] = a.data() + (first + k) * a.rows();
    factor[k] = x[first + k];
    sums[k] = 0;
  }
  std::ptrdiff_t i = 0;
  for (; i + lanes <= first; i += lanes) {
    const WholeLanes at{i};
    const Lanes here = at(x);
    Lanes sum = at(y);
#pragma GCC unroll 8
    for (int k = 0; k < columns; ++k) {
      const Lanes entry = at(column[k]);
      sum += entry * factor[k];
      sums[k] += entry * here;
    }
    at.put(y, sum);
  }
  double total[columns];
  for (int k = 0; k < columns; ++k) total[k] = uplift::sum(sums[k]);
  const auto entry_above = [&](std::ptrdiff_t row, int k) {
    y[row] += column[k][row] * x[first + k];
    total[k] += column[k][row] * x[row];
  };
  for (; i < first; ++i)
    for (int k = 0; k < columns; ++k) entry_above(i, k);
  for (int k = 0; k < columns; ++k) y[first + k] = 0;
  for (int k = 0; k < columns; ++k) {
    for (int above = 0; above < k; ++above) entry_above(first + above, k);
    total[k] += column[k][first + k] * x[first + k];
  }
  for (int k = 0; k < columns; ++k) y[first + k] += total[k];
}

}  // namespace

void multiply_symmetric(const Matrix& a, const double* x, double* y) {
  constexpr int at_once = 4;
  std::ptrdiff_t first = 0;
  for (; first + at_once <= a.cols(); first += at_once) add_symmetric_columns<at_once>(a, first, x, y);
  for (; first < a.cols(); ++first) add_symmetric_columns<1>(a, first, x, y);
}

}  // namespace uplift::small
