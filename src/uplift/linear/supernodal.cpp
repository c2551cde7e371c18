#include "uplift/linear/supernodal.h"

namespace uplift {

namespace {

/// One supernode: w columns, h rows, of which the first w are the triangle.
struct Block {
  std::ptrdiff_t w, h;
  const double* values;
  const int* below;  // numbers of the rows under the triangle
  int first;
};

Block block(const Supernodes& factor, std::size_t s) {
  const std::ptrdiff_t w = factor.super[s + 1] - factor.super[s], h = factor.pi[s + 1] - factor.pi[s];
  return {w, h, factor.values + factor.px[s], factor.rows + factor.pi[s] + w, factor.super[s]};
}

/// sum[i] (+)= the four columns times x, for i in [0, n)
template <bool Add>
void four_columns(std::ptrdiff_t n, const double* a, std::ptrdiff_t stride, const double* x, double* sum) {
  const double *a0 = a, *a1 = a + stride, *a2 = a1 + stride, *a3 = a2 + stride;
  const double x0 = x[0], x1 = x[1], x2 = x[2], x3 = x[3];
#pragma omp simd
  for (std::ptrdiff_t i = 0; i < n; ++i) sum[i] = (Add ? sum[i] : 0.0) + ((a0[i] * x0 + a1[i] * x1) + (a2[i] * x2 + a3[i] * x3));
}

template <bool Add>
void one_column(std::ptrdiff_t n, const double* a, double x, double* sum) {
#pragma omp simd
  for (std::ptrdiff_t i = 0; i < n; ++i) sum[i] = (Add ? sum[i] : 0.0) + a[i] * x;
}

/// sum = the rows under the triangle times x
void multiply_below(const Block& b, const double* x, double* sum) {
  const std::ptrdiff_t n = b.h - b.w;
  const double* a = b.values + b.w;
  std::ptrdiff_t c = 0;
  if (b.w >= 4) {
    four_columns<false>(n, a, b.h, x, sum);
    for (c = 4; c + 4 <= b.w; c += 4) four_columns<true>(n, a + c * b.h, b.h, x + c, sum);
  } else {
    one_column<false>(n, a, x[0], sum);
    c = 1;
  }
  for (; c < b.w; ++c) one_column<true>(n, a + c * b.h, x[c], sum);
}

/// x -= (the rows under the triangle)^T sum
void multiply_below_transposed(const Block& b, const double* sum, double* x) {
  const std::ptrdiff_t n = b.h - b.w;
  const double* a = b.values + b.w;
  std::ptrdiff_t c = 0;
  for (; c + 4 <= b.w; c += 4) {
    const double *a0 = a + c * b.h, *a1 = a0 + b.h, *a2 = a1 + b.h, *a3 = a2 + b.h;
    double s0 = 0, s1 = 0, s2 = 0, s3 = 0;
#pragma omp simd reduction(+ : s0, s1, s2, s3)
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      s0 += a0[i] * sum[i];
      s1 += a1[i] * sum[i];
      s2 += a2[i] * sum[i];
      s3 += a3[i] * sum[i];
    }
    x[c] -= s0, x[c + 1] -= s1, x[c + 2] -= s2, x[c + 3] -= s3;
  }
  for (; c < b.w; ++c) {
    double s = 0;
    const double* column = a + c * b.h;
#pragma omp simd reduction(+ : s)
    for (std::ptrdiff_t i = 0; i < n; ++i) s += column[i] * sum[i];
    x[c] -= s;
  }
}

}  // namespace

void solve_lower(const Supernodes& factor, double* x, double* scratch) {
  for (std::size_t s = 0; s < factor.count; ++s) {
    const Block b = block(factor, s);
    double* top = x + b.first;
    for (std::ptrdiff_t c = 0; c < b.w; ++c) {
      const double* column = b.values + c * b.h;
      const double value = top[c] /= column[c];
#pragma omp simd
      for (std::ptrdiff_t i = c + 1; i < b.w; ++i) top[i] -= column[i] * value;
    }
    const std::ptrdiff_t n = b.h - b.w;
    if (n == 0) continue;
    multiply_below(b, top, scratch);
    for (std::ptrdiff_t i = 0; i < n; ++i) x[b.below[i]] -= scratch[i];
  }
}

void solve_lower_transposed(const Supernodes& factor, double* x, double* scratch) {
  for (std::size_t s = factor.count; s-- > 0;) {
    const Block b = block(factor, s);
    double* top = x + b.first;
    const std::ptrdiff_t n = b.h - b.w;
    if (n > 0) {
      for (std::ptrdiff_t i = 0; i < n; ++i) scratch[i] = x[b.below[i]];
      multiply_below_transposed(b, scratch, top);
    }
    for (std::ptrdiff_t c = b.w; c-- > 0;) {
      const double* column = b.values + c * b.h;
      double sum = 0;
#pragma omp simd reduction(+ : sum)
      for (std::ptrdiff_t i = c + 1; i < b.w; ++i) sum += column[i] * top[i];
      top[c] = (top[c] - sum) / column[c];
    }
  }
}

}  // namespace uplift
