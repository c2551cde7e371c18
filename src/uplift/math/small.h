#pragma once
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "uplift/math/lanes.h"
#include "uplift/math/small_product.h"

// Kernels for the few unknowns of an interface under a rigid body and for small bulks: plain loops over contiguous columns that the
// compiler turns into vector code; Eigen's general products cost more than the arithmetic at these sizes.
namespace uplift::small {

/// Calls work(n), with n known to the compiler where it is small: loops over it then have neither a beginning nor an end.
template <class Work>
inline void with_size(std::ptrdiff_t n, const Work& work) {
  switch (n) {
    case 2:
      return work(std::integral_constant<std::ptrdiff_t, 2>());
    case 3:
      return work(std::integral_constant<std::ptrdiff_t, 3>());
    case 4:
      return work(std::integral_constant<std::ptrdiff_t, 4>());
    case 5:
      return work(std::integral_constant<std::ptrdiff_t, 5>());
    case 6:
      return work(std::integral_constant<std::ptrdiff_t, 6>());
    case 7:
      return work(std::integral_constant<std::ptrdiff_t, 7>());
    case 8:
      return work(std::integral_constant<std::ptrdiff_t, 8>());
    default:
      return work(n);
  }
}

inline double dot(std::ptrdiff_t n, const double* a, const double* b) {
  double total = 0;
  std::ptrdiff_t i = 0;
  if (n >= lanes) {
    Lanes part = 0;
    for (; i + lanes <= n; i += lanes) {
      const WholeLanes at{i};
      part += at(a) * at(b);
    }
    total = uplift::sum(part);
  }
  for (; i < n; ++i) total += a[i] * b[i];
  return total;
}

inline double sum_of_squares(std::ptrdiff_t n, const double* a) {
  return dot(n, a, a);
}

/// A few numbers: for them the library's copy costs more than the copying.
inline void copy(std::ptrdiff_t n, const double* from, double* to) {
  for_lanes(
      n, [=](const auto& at) __attribute__((always_inline)) { at.put(to, at(from)); });
}

/// y += factor * x
inline void add(std::ptrdiff_t n, double factor, const double* x, double* y) {
#pragma omp simd
  for (std::ptrdiff_t i = 0; i < n; ++i) y[i] += factor * x[i];
}

/// y += A x
inline void multiply_add(const Matrix& a, const double* x, double* y) {
  const std::ptrdiff_t n = a.rows(), m = a.cols();
  const double* column = a.data();
  for (std::ptrdiff_t j = 0; j < m; ++j, column += n) add(n, x[j], column, y);
}

/// y = b + factor A x, in one pass where A has few columns; y may be b.
void affine(const Matrix& a, const double* b, const double* x, double* y, double factor = 1);

/// y += A^T x for n rows of m columns, `stride` apart. R: their number where the compiler shall know it (one pass), else 0.
template <int R>
void add_transposed(std::ptrdiff_t n, std::ptrdiff_t m, const double* a, std::ptrdiff_t stride, const double* x, double* y) {
  if constexpr (R == 0) {
    for (std::ptrdiff_t j = 0; j < m; ++j, a += stride) y[j] += dot(n, a, x);
  } else {
    Lanes total[R] = {};
    for_lanes(n, [&](const auto& at) {
      for (int r = 0; r < R; ++r) total[r] += at(a + r * stride) * at(x);
    });
    for (int r = 0; r < R; ++r) y[r] += sum(total[r]);
  }
}

/// Solves A x = b in place by Gauss elimination without exchanges of rows, with everything where the compiler knows it; false, with nothing
/// changed, where a pivot is less than a tenth of the largest number below it.
template <int N>
[[gnu::always_inline]] inline bool gauss_solve_in_order(const double* a, double* b) {
  double m[N * N], x[N];
  for (int i = 0; i < N * N; ++i) m[i] = a[i];
  for (int i = 0; i < N; ++i) x[i] = b[i];
  for (int j = 0; j < N; ++j) {
    double below = 0;
    for (int i = j + 1; i < N; ++i) below = larger(below, std::abs(m[j * N + i]));
    if (!(std::abs(m[j * N + j]) > 0.1 * below)) return false;
    const double inverse = m[j * N + j] = 1 / m[j * N + j];
    for (int i = j + 1; i < N; ++i) {
      const double factor = m[j * N + i] * inverse;
      for (int k = j + 1; k < N; ++k) m[k * N + i] -= factor * m[k * N + j];
      x[i] -= factor * x[j];
    }
  }
  for (int j = N; j-- > 0;) {
    x[j] *= m[j * N + j];
    for (int i = 0; i < j; ++i) x[i] -= m[j * N + i] * x[j];
  }
  for (int i = 0; i < N; ++i) b[i] = x[i];
  return true;
}

/// Solves A x = b in place by Gauss elimination with row pivoting; A is destroyed; false when singular. N > 0: a size that the compiler
/// knows, so that the loops unroll. The pivots are divided by once, while b may still be under way.
template <int N>
bool gauss_solve(std::ptrdiff_t size, double* a, double* b) {
  if constexpr (N > 0)
    if (gauss_solve_in_order<N>(a, b)) return true;
  const std::ptrdiff_t n = N > 0 ? N : size;
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    std::ptrdiff_t best = j;
    for (std::ptrdiff_t i = j + 1; i < n; ++i)
      if (std::abs(a[j * n + i]) > std::abs(a[j * n + best])) best = i;
    if (!(std::abs(a[j * n + best]) > 0)) return false;
    if (best != j) {
      for (std::ptrdiff_t k = j; k < n; ++k) std::swap(a[k * n + j], a[k * n + best]);
      std::swap(b[j], b[best]);
    }
    const double inverse = a[j * n + j] = 1 / a[j * n + j];
    for (std::ptrdiff_t i = j + 1; i < n; ++i) {
      const double factor = a[j * n + i] * inverse;
      for (std::ptrdiff_t k = j + 1; k < n; ++k) a[k * n + i] -= factor * a[k * n + j];
      b[i] -= factor * b[j];
    }
  }
  for (std::ptrdiff_t j = n; j-- > 0;) {
    b[j] *= a[j * n + j];
    for (std::ptrdiff_t i = 0; i < j; ++i) b[i] -= a[j * n + i] * b[j];
  }
  return true;
}

/// One pass over the points: gradient g[r] += sum C[:,r] p and H[r,s] += sum C[:,r] k C[:,s] (full symmetric, column-major R x R), R
/// columns with stride `rows`.
template <int R>
[[gnu::always_inline]] inline void gradient_and_gram(std::ptrdiff_t n, const double* c, std::ptrdiff_t rows, const double* p,
                                                     const double* k, double* g, double* h) {
  Lanes total[R] = {}, gram[R][R] = {};  // gram: lower triangle
  for_lanes(n, [&](const auto& at) {
    for (int s = 0; s < R; ++s) {
      const Lanes column = at(c + s * rows), weighted = at(k) * column;
      total[s] += column * at(p);
      for (int r = s; r < R; ++r) gram[s][r] += weighted * at(c + r * rows);
    }
  });
  for (int s = 0; s < R; ++s) {
    g[s] += sum(total[s]);
    for (int r = s; r < R; ++r) {
      const double entry = sum(gram[s][r]);
      h[s * R + r] += entry;
      if (r != s) h[r * R + s] += entry;
    }
  }
}

}  // namespace uplift::small
