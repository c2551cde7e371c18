#include "uplift/linear/supernodal.h"

#include <algorithm>

namespace uplift {

namespace {

/// One supernode: w columns, h rows, of which the first w are the triangle.
struct Block {
  std::ptrdiff_t w, h;
  const double* values;
  const int* rows;  // their numbers
  int first;        // number of the first column
};

Block block(const Supernodes& factor, std::size_t s) {
  const std::ptrdiff_t w = factor.super[s + 1] - factor.super[s], h = factor.pi[s + 1] - factor.pi[s];
  return {w, h, factor.values + factor.px[s], factor.rows + factor.pi[s], factor.super[s]};
}

/// v[i] -= the four columns times x, for i in [from, n)
void take_four(std::ptrdiff_t from, std::ptrdiff_t n, const double* a, std::ptrdiff_t stride, const double* x, double* v) {
  const double *a0 = a, *a1 = a + stride, *a2 = a1 + stride, *a3 = a2 + stride;
  const double x0 = x[0], x1 = x[1], x2 = x[2], x3 = x[3];
#pragma omp simd
  for (std::ptrdiff_t i = from; i < n; ++i) v[i] -= (a0[i] * x0 + a1[i] * x1) + (a2[i] * x2 + a3[i] * x3);
}

void take_one(std::ptrdiff_t from, std::ptrdiff_t n, const double* a, double x, double* v) {
#pragma omp simd
  for (std::ptrdiff_t i = from; i < n; ++i) v[i] -= a[i] * x;
}

/// s[k] = column k . v over [from, n), for four columns
void dot_four(std::ptrdiff_t from, std::ptrdiff_t n, const double* a, std::ptrdiff_t stride, const double* v, double* s) {
  const double *a0 = a, *a1 = a + stride, *a2 = a1 + stride, *a3 = a2 + stride;
  double s0 = 0, s1 = 0, s2 = 0, s3 = 0;
#pragma omp simd reduction(+ : s0, s1, s2, s3)
  for (std::ptrdiff_t i = from; i < n; ++i) {
    s0 += a0[i] * v[i];
    s1 += a1[i] * v[i];
    s2 += a2[i] * v[i];
    s3 += a3[i] * v[i];
  }
  s[0] = s0, s[1] = s1, s[2] = s2, s[3] = s3;
}

double dot_one(std::ptrdiff_t from, std::ptrdiff_t n, const double* a, const double* v) {
  double sum = 0;
#pragma omp simd reduction(+ : sum)
  for (std::ptrdiff_t i = from; i < n; ++i) sum += a[i] * v[i];
  return sum;
}

/// v[0 ... h) holds the right-hand side of the supernode's own rows, then zeros: they become the solution and what the rows below lose.
void lower_block(const Block& b, double* v) {
  std::ptrdiff_t c = 0;
  for (; c + 4 <= b.w; c += 4) {
    for (std::ptrdiff_t j = 0; j < 4; ++j) {  // the triangle on the diagonal
      double value = v[c + j];
      const double* row = b.values + c * b.h + c + j;
      for (std::ptrdiff_t k = 0; k < j; ++k) value -= row[k * b.h] * v[c + k];
      v[c + j] = value / row[j * b.h];
    }
    take_four(c + 4, b.h, b.values + c * b.h, b.h, v + c, v);
  }
  for (; c < b.w; ++c) {
    const double* a = b.values + c * b.h;
    v[c] /= a[c];
    take_one(c + 1, b.h, a, v[c], v);
  }
}

/// v[0 ... h) holds the right-hand side of the supernode's own rows, then the solution of the rows below.
void transposed_block(const Block& b, double* v) {
  std::ptrdiff_t c = b.w;
  for (; c % 4 != 0; --c) {
    const double* a = b.values + (c - 1) * b.h;
    v[c - 1] = (v[c - 1] - dot_one(c, b.h, a, v)) / a[c - 1];
  }
  for (; c > 0; c -= 4) {
    double sum[4];
    dot_four(c, b.h, b.values + (c - 4) * b.h, b.h, v, sum);
    for (std::ptrdiff_t j = 4; j-- > 0;) {
      const std::ptrdiff_t column = c - 4 + j;
      const double* a = b.values + column * b.h;
      double value = v[column] - sum[j];
      for (std::ptrdiff_t k = column + 1; k < c; ++k) value -= a[k] * v[k];
      v[column] = value / a[column];
    }
  }
}

}  // namespace

void solve_lower(const Supernodes& factor, double* x, double* scratch) {
  for (std::size_t s = 0; s < factor.count; ++s) {
    const Block b = block(factor, s);
    double* top = x + b.first;
    std::copy_n(top, b.w, scratch);
    std::fill_n(scratch + b.w, b.h - b.w, 0.0);
    lower_block(b, scratch);
    std::copy_n(scratch, b.w, top);
    for (std::ptrdiff_t i = b.w; i < b.h; ++i) x[b.rows[i]] += scratch[i];
  }
}

void solve_lower_transposed(const Supernodes& factor, double* x, double* scratch) {
  for (std::size_t s = factor.count; s-- > 0;) {
    const Block b = block(factor, s);
    for (std::ptrdiff_t i = 0; i < b.h; ++i) scratch[i] = x[b.rows[i]];
    transposed_block(b, scratch);
    std::copy_n(scratch, b.w, x + b.first);
  }
}

}  // namespace uplift
