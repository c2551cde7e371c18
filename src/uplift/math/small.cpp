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

bool cholesky(std::ptrdiff_t n, double* a) {
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    double pivot = a[j * n + j];
    const double scale = pivot;
    for (std::ptrdiff_t k = 0; k < j; ++k) pivot -= a[k * n + j] * a[k * n + j];
    if (!(pivot > 1e-14 * scale) || !(scale > 0)) return false;
    const double root = std::sqrt(pivot);
    a[j * n + j] = root;
    for (std::ptrdiff_t i = j + 1; i < n; ++i) {
      double value = a[j * n + i];
      for (std::ptrdiff_t k = 0; k < j; ++k) value -= a[k * n + i] * a[k * n + j];
      a[j * n + i] = value / root;
    }
  }
  return true;
}

void cholesky_solve(std::ptrdiff_t n, const double* l, double* b) {
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    b[j] /= l[j * n + j];
    for (std::ptrdiff_t i = j + 1; i < n; ++i) b[i] -= l[j * n + i] * b[j];
  }
  for (std::ptrdiff_t j = n; j-- > 0;) {
    for (std::ptrdiff_t i = j + 1; i < n; ++i) b[j] -= l[j * n + i] * b[i];
    b[j] /= l[j * n + j];
  }
}

}  // namespace uplift::small
