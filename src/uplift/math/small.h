#pragma once
#include <cstddef>

#include "uplift/math/fixed.h"

// Kernels for the few unknowns of an interface under a rigid body and for small bulks: plain loops over contiguous columns that the
// compiler turns into vector code; Eigen's general products cost more than the arithmetic at these sizes.
namespace uplift::small {

inline double dot(std::ptrdiff_t n, const double* a, const double* b) {
  double sum = 0;
  if (n < 8) {  // to begin and end a vector loop would cost more than the sum
    for (std::ptrdiff_t i = 0; i < n; ++i) sum += a[i] * b[i];
    return sum;
  }
#pragma omp simd reduction(+ : sum)
  for (std::ptrdiff_t i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

inline double sum_of_squares(std::ptrdiff_t n, const double* a) {
  return dot(n, a, a);
}

/// y += factor * x
inline void add(std::ptrdiff_t n, double factor, const double* x, double* y) {
#pragma omp simd
  for (std::ptrdiff_t i = 0; i < n; ++i) y[i] += factor * x[i];
}

/// y = A x for a square matrix whose size the compiler knows.
template <int N>
inline void multiply_fixed(const double* a, const double* x, double* y) {
  Eigen::Map<Fixed<N, 1>>(y).noalias() = Eigen::Map<const Fixed<N, N>>(a) * Eigen::Map<const Fixed<N, 1>>(x);
}

/// y = A x, A column-major n x m
inline void multiply(const Matrix& a, const double* x, double* y) {
  const std::ptrdiff_t n = a.rows(), m = a.cols();
  if (n == m) switch (n) {
      case 1:
        return multiply_fixed<1>(a.data(), x, y);
      case 2:
        return multiply_fixed<2>(a.data(), x, y);
      case 3:
        return multiply_fixed<3>(a.data(), x, y);
      case 4:
        return multiply_fixed<4>(a.data(), x, y);
      case 5:
        return multiply_fixed<5>(a.data(), x, y);
      case 6:
        return multiply_fixed<6>(a.data(), x, y);
      case 7:
        return multiply_fixed<7>(a.data(), x, y);
      case 8:
        return multiply_fixed<8>(a.data(), x, y);
      default:
        break;
    }
  const double* column = a.data();
  for (std::ptrdiff_t i = 0; i < n; ++i) y[i] = 0;
  for (std::ptrdiff_t j = 0; j < m; ++j, column += n) add(n, x[j], column, y);
}

/// y += A x
inline void multiply_add(const Matrix& a, const double* x, double* y) {
  const std::ptrdiff_t n = a.rows(), m = a.cols();
  const double* column = a.data();
  for (std::ptrdiff_t j = 0; j < m; ++j, column += n) add(n, x[j], column, y);
}

/// y = b + A x in one pass where A has few columns.
inline void affine(const Matrix& a, const double* b, const double* x, double* y) {
  const std::ptrdiff_t n = a.rows(), m = a.cols();
  const double* c = a.data();
  switch (m) {
    case 1: {
      const double x0 = x[0];
#pragma omp simd
      for (std::ptrdiff_t i = 0; i < n; ++i) y[i] = b[i] + c[i] * x0;
      return;
    }
    case 2: {
      const double x0 = x[0], x1 = x[1];
#pragma omp simd
      for (std::ptrdiff_t i = 0; i < n; ++i) y[i] = b[i] + c[i] * x0 + c[n + i] * x1;
      return;
    }
    case 3: {
      const double x0 = x[0], x1 = x[1], x2 = x[2];
#pragma omp simd
      for (std::ptrdiff_t i = 0; i < n; ++i) y[i] = b[i] + c[i] * x0 + c[n + i] * x1 + c[2 * n + i] * x2;
      return;
    }
    default:
      for (std::ptrdiff_t i = 0; i < n; ++i) y[i] = b[i];
      multiply_add(a, x, y);
  }
}

/// y += A^T x for n rows of m columns, `stride` apart. R: their number where the compiler shall know it (one pass), else 0.
template <int R>
void add_transposed(std::ptrdiff_t n, std::ptrdiff_t m, const double* a, std::ptrdiff_t stride, const double* x, double* y) {
  if constexpr (R == 2) {
    const double* other = a + stride;
    double sum = 0, sum_other = 0;
#pragma omp simd reduction(+ : sum, sum_other)
    for (std::ptrdiff_t i = 0; i < n; ++i) sum += a[i] * x[i], sum_other += other[i] * x[i];
    y[0] += sum, y[1] += sum_other;
  } else {
    for (std::ptrdiff_t j = 0; j < m; ++j, a += stride) y[j] += dot(n, a, x);
  }
}

/// In-place Cholesky factor (lower, column-major) of a small symmetric matrix; false when it is not positive definite.
bool cholesky(std::ptrdiff_t n, double* a);
/// Solves L L^T x = b in place.
void cholesky_solve(std::ptrdiff_t n, const double* l, double* b);
/// Solves A x = b in place by Gauss elimination with row pivoting; A is destroyed; false when singular.
bool gauss_solve(std::ptrdiff_t n, double* a, double* b);

/// One pass over the points: gradient g[r] += sum C[:,r] p and H[r,s] += sum C[:,r] k C[:,s] (full symmetric, column-major R x R), R
/// columns with stride `rows`.
template <int R>
void gradient_and_gram(std::ptrdiff_t n, const double* c, std::ptrdiff_t rows, const double* p, const double* k, double* g, double* h) {
  double sum[R] = {}, gram[R * (R + 1) / 2] = {};
  const double* column[R];
  for (int r = 0; r < R; ++r) column[r] = c + r * rows;
  if constexpr (R == 1) {
    double s0 = 0, a0 = 0;
#pragma omp simd reduction(+ : s0, a0)
    for (std::ptrdiff_t i = 0; i < n; ++i) s0 += column[0][i] * p[i], a0 += column[0][i] * k[i] * column[0][i];
    sum[0] = s0, gram[0] = a0;
  } else if constexpr (R == 2) {
    double s0 = 0, s1 = 0, a0 = 0, a1 = 0, a2 = 0;
#pragma omp simd reduction(+ : s0, s1, a0, a1, a2)
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      const double x = column[0][i], y = column[1][i], kx = k[i] * x, ky = k[i] * y;
      s0 += x * p[i], s1 += y * p[i];
      a0 += x * kx, a1 += y * kx, a2 += y * ky;
    }
    sum[0] = s0, sum[1] = s1, gram[0] = a0, gram[1] = a1, gram[2] = a2;
  } else {
    double s0 = 0, s1 = 0, s2 = 0, a0 = 0, a1 = 0, a2 = 0, a3 = 0, a4 = 0, a5 = 0;
#pragma omp simd reduction(+ : s0, s1, s2, a0, a1, a2, a3, a4, a5)
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      const double x = column[0][i], y = column[1][i], w = column[2][i], kx = k[i] * x, ky = k[i] * y, kw = k[i] * w;
      s0 += x * p[i], s1 += y * p[i], s2 += w * p[i];
      a0 += x * kx, a1 += y * kx, a2 += w * kx, a3 += y * ky, a4 += w * ky, a5 += w * kw;
    }
    sum[0] = s0, sum[1] = s1, sum[2] = s2;
    gram[0] = a0, gram[1] = a1, gram[2] = a2, gram[3] = a3, gram[4] = a4, gram[5] = a5;
  }
  for (int s = 0, entry = 0; s < R; ++s) {
    g[s] += sum[s];
    for (int r = s; r < R; ++r, ++entry) {
      h[s * R + r] += gram[entry];
      if (r != s) h[r * R + s] += gram[entry];
    }
  }
}

}  // namespace uplift::small
