#include "uplift/math/small.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "uplift/contact/kernel/kernel.h"

// The active set for at most three coordinates, as under a rigid footing in the plane. With A the closed rows and W their weights
//     G = C_A^T W C_A     z = -G^+ C_A^T W target     y = -G^+ z     p = W C_A y
// so that one pass over the rows forms G and the right-hand side, and one evaluates openings and pressures; both are vector code.
namespace uplift {

bool Visited::note(std::ptrdiff_t rows, const double* held) {
  std::uint64_t value = 14695981039346656037ull;  // FNV-1a, over 64 flags at a time: no chain of a product per row
  for (std::ptrdiff_t first = 0; first < rows; first += 64) {
    const std::ptrdiff_t some = std::min<std::ptrdiff_t>(64, rows - first);
    std::uint64_t flags = 0;
#pragma omp simd simdlen(8) reduction(| : flags)
    for (std::ptrdiff_t i = 0; i < some; ++i) flags |= static_cast<std::uint64_t>(held[first + i] > 0) << i;
    value = (value ^ flags) * 1099511628211ull;
    value ^= value >> 32;
  }
  const auto end = hash.begin() + count;
  if (count == static_cast<int>(hash.size()) || std::find(hash.begin(), end, value) != end) return false;
  hash[static_cast<std::size_t>(count++)] = value;
  return true;
}

namespace {

constexpr double rank_threshold = 1e-13;    // pivot relative to the largest: round-off of a sum of squares is 1e-16 of it
constexpr double column_threshold = 1e-24;  // square of a column that is nothing but round-off of the others
constexpr int most_small_iterations = 60;

template <int R>
inline constexpr int packed = R*(R + 1) / 2;

/// v = S x, S packed
template <int R>
void apply(const double* s, const double* x, double* v) {
  if constexpr (R == 1) {
    v[0] = s[0] * x[0];
  } else if constexpr (R == 2) {
    const double a = x[0], b = x[1];
    v[0] = s[0] * a + s[1] * b;
    v[1] = s[1] * a + s[2] * b;
  } else {
    const double a = x[0], b = x[1], c = x[2];
    v[0] = s[0] * a + s[1] * b + s[2] * c;
    v[1] = s[1] * a + s[3] * b + s[4] * c;
    v[2] = s[2] * a + s[4] * b + s[5] * c;
  }
}

/// Sums over the rows of one set.
template <int R>
struct Sums {
  double gram[packed<R>], right[R];  // sum held c c^T, -sum held c target
  double weight = 0, target = 0;     // sum held, sum target^2
};

template <int R>
[[gnu::always_inline]] inline void gather(std::ptrdiff_t n, const double* c, std::ptrdiff_t stride, const double* held,
                                          const double* target, Sums<R>& sums) {
  Lanes gram[packed<R>] = {}, right[R] = {}, weight = 0, square = 0;
  for_lanes(
      n, [&](const auto& at) __attribute__((always_inline)) {
        const Lanes h = at(held), t = at(target);
        for (int s = 0, entry = 0; s < R; ++s) {
          const Lanes weighted = h * at(c + s * stride);
          right[s] += weighted * t;
          for (int r = s; r < R; ++r, ++entry) gram[entry] += weighted * at(c + r * stride);
        }
        weight += h;
        square += t * t;
      });
  for (int k = 0; k < packed<R>; ++k) sums.gram[k] = sum(gram[k]);
  for (int r = 0; r < R; ++r) sums.right[r] = -sum(right[r]);
  sums.weight = sum(weight);
  sums.target = sum(square);
}

struct Look {
  double closed = 0;     // largest |opening| of a held row
  bool changes = false;  // some rows change sides
};

/// opening = target + C z, force = held * C y, and the next set: a closed row opens when its pressure C y is tensile; an open one closes
/// when it penetrates, or when it touches and the pressure field of the closed rows is compressive there (this makes the redundant
/// pressures those of least norm).
template <int R>
[[gnu::always_inline]] inline Look look(std::ptrdiff_t n, const double* c, std::ptrdiff_t stride, const double* held, const double* limit,
                                        const double* target, const double* z, const double* y, double gap, double weight, double work,
                                        double* opening, double* force, double* next) {
  const double pull = std::sqrt(1e-24 * std::max(work, 0.0) / weight);  // a pressure beyond 1e-12 of the mean one is noticed
  const Lanes zero = 0;
  Lanes closed = zero, of_opening[R], of_force[R];
  for (int r = 0; r < R; ++r) of_opening[r] = z[r], of_force[r] = y[r];
  LaneMask changes(false);
  for_lanes(
      n, [&](const auto& at) __attribute__((always_inline)) {
        Lanes o = at(target), f = zero;
        for (int r = 0; r < R; ++r) {
          const Lanes column = at(c + r * stride);
          o += column * of_opening[r], f += column * of_force[r];
        }
        const Lanes h = at(held), most = at(limit);
        const LaneMask may = most > zero, is_held = h > zero;
        const Lanes kept = choose(f > pull, zero, most), touching = choose(f < -pull, most, zero);
        const Lanes taken = choose(o < -gap, most, choose(o <= gap, touching, zero));
        const Lanes now = choose(may, choose(is_held, kept, taken), h);
        at.put(opening, o);
        at.put(force, h * choose(may && f > zero, zero, f));
        at.put(next, now);
        closed = larger(closed, choose(is_held, absolute(o), zero));
        changes = changes || now != h;
      });
  return {largest(closed), any(changes)};
}

/// right = -sum held c opening: what is left to correct.
template <int R>
void remainder(std::ptrdiff_t n, const double* c, std::ptrdiff_t stride, const double* held, const double* opening, double* right) {
  for (int r = 0; r < R; ++r) {
    const double* column = c + r * stride;
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::ptrdiff_t i = 0; i < n; ++i) sum += held[i] * column[i] * opening[i];
    right[r] = -sum;
  }
}

/// y = -G^+ z, refined until |z + G y| / |z|, which is returned, is round-off.
template <int R>
double solve_dual(const double* gram, const double* inverse, const double* z, double* y) {
  double step[R], size = 0, error = 0;
  for (int r = 0; r < R; ++r) y[r] = 0, step[r] = z[r], size += z[r] * z[r];
  if (!(size > 0)) return 0;
  for (int pass = 0; pass < 5; ++pass) {
    apply<R>(inverse, step, step);
    for (int r = 0; r < R; ++r) y[r] -= step[r];
    apply<R>(gram, y, step);
    error = 0;
    for (int r = 0; r < R; ++r) step[r] += z[r], error += step[r] * step[r];
    if (error <= 1e-26 * size) break;
  }
  return std::sqrt(error / size);
}

template <int R>
KernelReply active_set(const Rows& rows, double* held, double* z, double* opening, double* force, KernelScratch& scratch) {
  const std::ptrdiff_t n = rows.count;
  if (scratch.next.size() < n) scratch.next.setZero(n);
  double* next = scratch.next.data();
  KernelReply reply;
  Sums<R> sums;
  double inverse[packed<R>], y[R], step[R];
  scratch.visited.count = 0;
  for (reply.iterations = 1; reply.iterations <= most_small_iterations; ++reply.iterations) {
    gather<R>(n, rows.factor, rows.stride, held, rows.target, sums);
    if (!std::isfinite(sums.target)) {
      reply.end = KernelEnd::not_finite;
      return reply;
    }
    pseudo_inverse<R>(sums.gram, inverse);
    apply<R>(inverse, sums.right, z);
    const double size = std::sqrt(sums.target), gap = std::max(rows.tolerance, rows.relative * size);
    Look seen;
    for (int refinement = 0;; ++refinement) {
      reply.residual = solve_dual<R>(sums.gram, inverse, z, y);
      double work = 0;  // -y z = sum held (C y)^2 = sum held * mean square of the pressure
      for (int r = 0; r < R; ++r) work -= y[r] * z[r];
      seen = look<R>(n, rows.factor, rows.stride, held, rows.limit, rows.target, z, y, gap, sums.weight, work, opening, force, next);
      if (seen.closed <= 1e-13 * size || (refinement == 2 && seen.closed <= gap)) break;
      if (refinement == 2) return reply;  // the closed rows contradict each other, or something is not finite
      remainder<R>(n, rows.factor, rows.stride, held, opening, step);
      apply<R>(inverse, step, step);
      for (int r = 0; r < R; ++r) z[r] += step[r];
    }
    if (!seen.changes) {
      if (reply.residual > 1e-11) return reply;  // the rank was misjudged
      reply.end = KernelEnd::solved;
      if (size > 0) reply.residual = std::max(reply.residual, seen.closed / size);
      return reply;
    }
    small::copy(n, next, held);
    if (!scratch.visited.note(n, held)) {
      reply.cycles = 1;
      return reply;
    }
  }
  return reply;
}

}  // namespace

template <int R>
int pseudo_inverse(const double* g, double* inverse) {
  for (int i = 0; i < packed<R>; ++i) inverse[i] = 0;
  if constexpr (R == 1) {
    if (!(g[0] > 0)) return 0;
    inverse[0] = 1 / g[0];
    return 1;
  } else if constexpr (R == 2) {
    const double a = std::max(g[0], g[2]), determinant = g[0] * g[2] - g[1] * g[1];
    if (!(a > 0)) return 0;
    if (determinant > rank_threshold * g[0] * g[2] && std::min(g[0], g[2]) > column_threshold * a) {
      const double scale = 1 / determinant;
      inverse[0] = g[2] * scale, inverse[1] = -g[1] * scale, inverse[2] = g[0] * scale;
      return 2;
    }
    const double trace = g[0] + g[2], scale = 1 / (trace * trace);
    for (int i = 0; i < 3; ++i) inverse[i] = g[i] * scale;
    return 1;
  } else {
    // G = a u u^T + b v v^T + d w w^T by elimination with pivots i, j, k; u = (1, l1, l2), v = (0, 1, m), w = (0, 0, 1) in that order
    constexpr int at[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    int i = g[3] > g[0] ? 1 : 0;
    if (g[5] > g[at[i][i]]) i = 2;
    int j = i == 0 ? 1 : 0, k = i == 2 ? 1 : 2;
    const double a = g[at[i][i]];
    if (!(a > 0)) return 0;
    double l1 = g[at[j][i]] / a, l2 = g[at[k][i]] / a;
    double b = g[at[j][j]] - l1 * g[at[j][i]], c = g[at[k][k]] - l2 * g[at[k][i]];
    const double e = g[at[k][j]] - l2 * g[at[j][i]];
    if (c > b) std::swap(j, k), std::swap(l1, l2), std::swap(b, c);
    double n1[3], n2[3];
    const double u2 = 1 + l1 * l1 + l2 * l2;
    if (!(b > rank_threshold * a)) {
      const double scale = 1 / (a * u2 * u2);
      n1[i] = 1, n1[j] = l1, n1[k] = l2;
      for (int s = 0; s < 3; ++s)
        for (int r = s; r < 3; ++r) inverse[at[r][s]] = scale * n1[r] * n1[s];
      return 1;
    }
    const double m = e / b, d = c - m * e;
    if (d > rank_threshold * a) {
      const double ra = 1 / a, rb = 1 / b, rd = 1 / d, q = l1 * m - l2;
      inverse[at[i][i]] = ra + rb * l1 * l1 + rd * q * q;
      inverse[at[j][i]] = -rb * l1 - rd * m * q;
      inverse[at[k][i]] = rd * q;
      inverse[at[j][j]] = rb + rd * m * m;
      inverse[at[k][j]] = -rd * m;
      inverse[at[k][k]] = rd;
      return 3;
    }
    // rank 2: with an orthonormal basis N of the range, G^+ = N (N^T G N)^-1 N^T
    const double alpha = std::sqrt(u2);
    n1[i] = 1 / alpha, n1[j] = l1 / alpha, n1[k] = l2 / alpha;
    const double beta = n1[j] + m * n1[k];
    n2[i] = -beta * n1[i], n2[j] = 1 - beta * n1[j], n2[k] = m - beta * n1[k];
    const double gamma = std::sqrt(n2[0] * n2[0] + n2[1] * n2[1] + n2[2] * n2[2]);
    for (double& value : n2) value /= gamma;
    const double t11 = a * u2 + b * beta * beta, t12 = b * beta * gamma, t22 = b * gamma * gamma, scale = 1 / (a * u2 * t22);
    for (int s = 0; s < 3; ++s)
      for (int r = s; r < 3; ++r)
        inverse[at[r][s]] = scale * (t22 * n1[r] * n1[s] - t12 * (n1[r] * n2[s] + n2[r] * n1[s]) + t11 * n2[r] * n2[s]);
    return 2;
  }
}
template int pseudo_inverse<1>(const double*, double*);
template int pseudo_inverse<2>(const double*, double*);
template int pseudo_inverse<3>(const double*, double*);

KernelReply small_active_set(const Rows& rows, double* held, double* z, double* opening, double* force, KernelScratch& scratch) {
  if (rows.columns == 1) return active_set<1>(rows, held, z, opening, force, scratch);
  if (rows.columns == 2) return active_set<2>(rows, held, z, opening, force, scratch);
  return active_set<3>(rows, held, z, opening, force, scratch);
}

}  // namespace uplift
