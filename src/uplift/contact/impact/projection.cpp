#include "uplift/contact/impact/projection.h"

#include <algorithm>
#include <cmath>

#include "uplift/math/small.h"

namespace uplift {
namespace {

void size_scratch(Index rows, Index r, ImpactScratch& scratch) {
  if (scratch.target.size() == rows && scratch.y.size() == r) return;
  for (Vector* vector :
       {&scratch.target, &scratch.limit, &scratch.fixed, &scratch.held, &scratch.rate, &scratch.taken, &scratch.impulse, &scratch.total})
    vector->setZero(rows);
  scratch.y.setZero(r);
  scratch.push.setZero(r);
}

/// y = A x over a range of rows, four columns at a time: the pass is bound by its loads and stores.
void multiply(const Matrix& a, Index first, Index n, const double* x, double* y) {
  const Index rows = a.rows(), columns = a.cols();
  const double* column = a.data() + first;
  std::fill_n(y, n, 0.0);
  Index k = 0;
  for (; k + 4 <= columns; k += 4, column += 4 * rows) {
    const double *c0 = column, *c1 = column + rows, *c2 = c1 + rows, *c3 = c2 + rows;
    const double x0 = x[k], x1 = x[k + 1], x2 = x[k + 2], x3 = x[k + 3];
#pragma omp simd
    for (Index i = 0; i < n; ++i) y[i] += (c0[i] * x0 + c1[i] * x1) + (c2[i] * x2 + c3[i] * x3);
  }
  for (; k < columns; ++k, column += rows) small::add(n, x[k], column, y);
}

/// push = weight C^T taken, target = B v + s + C push, for R columns of C and a full B, on the range of active rows.
template <int R>
void form_targets(const Impact& impact, const Vector& v, const Vector* moved, double weight, ImpactScratch& scratch) {
  const Index first = scratch.first, n = scratch.count, stride = impact.b->rows();
  const double *b = impact.b->data() + first, *c = impact.mass->factor.data() + first, *taken = scratch.taken.data() + first;
  const double *rate = v.data(), *more = moved != nullptr ? moved->data() + first : nullptr;
  double* target = scratch.target.data() + first;
  Lanes sums[R] = {}, push[R];
  Index whole = 0;  // numbers in registers
  for (; whole + lanes <= n; whole += lanes)
    for (int r = 0; r < R; ++r) sums[r] += WholeLanes{whole}(c + r * stride) * WholeLanes{whole}(taken);
  for (int r = 0; r < R; ++r) {
    double total = sum(sums[r]);
    for (Index i = whole; i < n; ++i) total += c[r * stride + i] * taken[i];
    push[r] = scratch.push[r] = weight * total;
  }
  small::with_size(impact.b->cols(), [&](auto columns) {
    for_lanes(
        n, [&](const auto& at) __attribute__((always_inline)) {
          Lanes total = 0;
          const double* column = b;
          Index k = 0;
          for (; k + 4 <= columns; k += 4, column += 4 * stride)
            total += (at(column) * rate[k] + at(column + stride) * rate[k + 1]) +
                     (at(column + 2 * stride) * rate[k + 2] + at(column + 3 * stride) * rate[k + 3]);
          for (; k < columns; ++k, column += stride) total += at(column) * rate[k];
          if (more != nullptr) total += at(more);
          for (int r = 0; r < R; ++r) total += at(c + r * stride) * push[r];
          at.put(target, total);
        });
  });
}

/// The same for any B and C.
void form_targets_in_general(const Impact& impact, const Vector& v, const Vector* moved, double weight, ImpactScratch& scratch) {
  const Matrix& c = impact.mass->factor;
  const Index first = scratch.first, n = scratch.count;
  row_rates(impact, v, moved, first, n, scratch.target);
  for (Index k = 0; k < c.cols(); ++k) {
    const double* column = c.data() + k * c.rows() + first;
    scratch.push[k] = weight * small::dot(n, column, scratch.taken.data() + first);
    small::add(n, scratch.push[k], column, scratch.target.data() + first);
  }
}

constexpr double at_rest = 1e-12;  // rate that counts as zero, relative to the rates of the rows

}  // namespace

void row_rates(const Impact& impact, const Vector& v, const Vector* moved, Index first, Index n, Vector& result) {
  if (impact.b != nullptr)
    multiply(*impact.b, first, n, v.data(), result.data() + first);
  else
    result.noalias() = *impact.sparse_b * v;
  if (moved != nullptr) small::add(n, 1, moved->data() + first, result.data() + first);
}

bool select_rows(const Impact& impact, Hold hold, ImpactScratch& scratch) {
  const Index rows = impact.mass->factor.rows();
  size_scratch(rows, impact.mass->factor.cols(), scratch);
  const bool take = hold == Hold::inequality;
  const double *force = impact.force->data(), *pressed = impact.pressed->data();
  double *weight = (take ? scratch.limit : scratch.fixed).data(), *other = (take ? scratch.fixed : scratch.limit).data();
  double* taken = scratch.taken.data();
  const Lanes zero = 0;
  Index least = rows, most = -1;  // groups of lanes
  for_lanes(
      rows, [&](const auto& at) __attribute__((always_inline)) {
        const Lanes here = at(pressed);
        const LaneMask active = here > zero;
        at.put(weight, here);
        at.put(other, zero);
        at.put(taken, take ? choose(active, at(force), zero) : zero);
        if (any(active)) least = std::min(least, at.first), most = at.first;
      });
  scratch.count = 0;
  if (most < 0) return false;
  for (const int row : impact.tangents) {
    least = std::min<Index>(least, row - row % lanes), most = std::max<Index>(most, row - row % lanes);
    scratch.fixed[row] = impact.area != nullptr ? (*impact.area)[row] : 1.0;
    taken[row] = take ? force[row] : 0;
  }
  scratch.any_fixed = !take || !impact.tangents.empty();
  // whole vector registers; with many columns all rows, so that the kernel's work space keeps its size
  const bool all = impact.mass->factor.cols() > 3;
  scratch.first = all ? 0 : least;
  scratch.count = all ? rows : std::min(rows, most + lanes) - scratch.first;
  return true;
}

void project_rate(const Impact& impact, const Vector& rate, const Vector* moved, double weight, Select select, ImpactScratch& scratch) {
  const Matrix& c = impact.mass->factor;
  const Index first = scratch.first, n = scratch.count, r = c.cols();
  double* limit = scratch.limit.data() + first;
  double* target = scratch.target.data() + first;
  if (select == Select::held) {
    const double largest = std::sqrt(small::sum_of_squares(n, target));
    const double* before = scratch.rate.data() + first;
#pragma omp simd
    for (Index i = 0; i < n; ++i) limit[i] = before[i] > 1e3 * at_rest * largest ? 0 : limit[i];
  }
  const bool full = impact.b != nullptr;
  if (full && r == 1)
    form_targets<1>(impact, rate, moved, weight, scratch);
  else if (full && r == 2)
    form_targets<2>(impact, rate, moved, weight, scratch);
  else if (full && r == 3)
    form_targets<3>(impact, rate, moved, weight, scratch);
  else
    form_targets_in_general(impact, rate, moved, weight, scratch);
  Rows rows{n, r, c.rows(), c.data() + first, target, limit, scratch.any_fixed ? scratch.fixed.data() + first : nullptr, 0, at_rest};
  for (;;) {
    small::copy(n, limit, scratch.held.data() + first);
    const KernelReply reply = solve_rows(rows, scratch.held.data() + first, scratch.y.data(), scratch.rate.data() + first,
                                         scratch.impulse.data() + first, scratch.kernel);
    if (reply.solved()) return;
    if (reply.end != KernelEnd::inconsistent) break;
    scratch.limit[first + reply.worst] = scratch.fixed[first + reply.worst] = 0;  // a row that moves no mass has no impulse
  }
  // not finite: nothing is corrected, the step fails by its energy
  for (Index k = 0; k < r; ++k) scratch.y[k] = -scratch.push[k];
  for (Index i = first; i < first + n; ++i) scratch.impulse[i] = weight * scratch.taken[i];
}

void correct(const Impact& impact, double factor, Vector& rate, ImpactScratch& scratch) {
  for (Index k = 0; k < scratch.y.size(); ++k) scratch.push[k] += scratch.y[k];
  impact.mass->add(factor, scratch.push, rate);
}

void add_impulse(const Impact& impact, double factor, Vector& impulse, const ImpactScratch& scratch) {
  if (impulse.size() == 0) return;
  const double *total = scratch.impulse.data(), *taken = scratch.taken.data(), weight = impact.velocity_weight;
  double* sum = impulse.data();
#pragma omp simd
  for (Index i = scratch.first; i < scratch.first + scratch.count; ++i) sum[i] += factor * (total[i] - weight * taken[i]);
}

}  // namespace uplift
