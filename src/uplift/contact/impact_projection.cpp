#include "uplift/contact/impact_projection.h"

#include <algorithm>
#include <cmath>

#include "uplift/math/small.h"

namespace uplift {
namespace {

void size_scratch(Index rows, Index r, ImpactScratch& scratch) {
  if (scratch.target.size() == rows && scratch.y.size() == r) return;
  for (Vector* vector : {&scratch.target, &scratch.limit, &scratch.fixed, &scratch.held, &scratch.rate, &scratch.taken, &scratch.impulse})
    vector->setZero(rows);
  scratch.y.setZero(r);
  scratch.push.setZero(r);
}

/// The smallest range of rows that holds the active ones.
struct Range {
  Index first = 0, count = 0;
};
Range range_of(const Impact& impact) {
  int first = impact.normals.front(), last = first;
  for (const std::vector<int>* rows : {&impact.normals, &impact.tangents})
    for (const int row : *rows) first = std::min(first, row), last = std::max(last, row);
  return {first, last - first + 1};
}

}  // namespace

void row_rates(const Impact& impact, const Vector& v, Vector& result) {
  if (impact.b != nullptr)
    small::multiply(*impact.b, v.data(), result.data());
  else
    result.noalias() = *impact.sparse_b * v;
}

bool select_rows(const Impact& impact, Hold hold, ImpactScratch& scratch) {
  const Index rows = impact.mass->factor.rows();
  size_scratch(rows, impact.mass->factor.cols(), scratch);
  if (impact.normals.empty()) return false;
  const auto share = [&](int row) { return impact.area != nullptr ? (*impact.area)[row] : 1.0; };
  for (Vector* vector : {&scratch.limit, &scratch.fixed, &scratch.taken, &scratch.impulse}) std::fill_n(vector->data(), rows, 0.0);
  Vector& normal = hold == Hold::inequality ? scratch.limit : scratch.fixed;
  for (const int row : impact.normals) normal[row] = share(row);
  for (const int row : impact.tangents) scratch.fixed[row] = share(row);
  scratch.any_fixed = hold == Hold::equality || !impact.tangents.empty();
  if (hold == Hold::equality) return true;
  for (const std::vector<int>* list : {&impact.normals, &impact.tangents})
    for (const int row : *list) scratch.taken[row] = (*impact.force)[row];
  return true;
}

void project_rate(const Impact& impact, const Vector& rate, double weight, Select select, ImpactScratch& scratch) {
  const Matrix& c = impact.mass->factor;
  const Range range = range_of(impact);
  const Index first = range.first, n = range.count;
  if (select == Select::held) {
    double largest = 0;
    for (Index i = first; i < first + n; ++i) largest = std::max(largest, std::abs(scratch.target[i]));
    for (Index i = first; i < first + n; ++i)
      if (scratch.rate[i] > 1e-9 * largest) scratch.limit[i] = 0;
  }
  row_rates(impact, rate, scratch.target);
  for (Index k = 0; k < c.cols(); ++k)
    scratch.push[k] = weight * small::dot(n, c.data() + k * c.rows() + first, scratch.taken.data() + first);
  double largest = 0;
  for (Index k = 0; k < c.cols(); ++k) small::add(n, scratch.push[k], c.data() + k * c.rows() + first, scratch.target.data() + first);
  for (Index i = first; i < first + n; ++i)
    if (scratch.limit[i] > 0 || scratch.fixed[i] > 0) largest = std::max(largest, std::abs(scratch.target[i]));
  std::copy_n(scratch.limit.data() + first, n, scratch.held.data() + first);
  Rows rows{n, c.cols(), c.rows(), c.data() + first, scratch.target.data() + first, scratch.limit.data() + first,
            scratch.any_fixed ? scratch.fixed.data() + first : nullptr, 1e-12 * largest};
  for (;;) {
    const KernelReply reply = solve_rows(rows, scratch.held.data() + first, scratch.y.data(), scratch.rate.data() + first,
                                         scratch.impulse.data() + first, scratch.kernel);
    if (reply.solved()) return;
    if (reply.end != KernelEnd::inconsistent) break;
    scratch.limit[first + reply.worst] = scratch.fixed[first + reply.worst] = 0;  // a row that moves no mass has no impulse
    std::copy_n(scratch.limit.data() + first, n, scratch.held.data() + first);
  }
  // not finite: the step fails by its energy; nothing is corrected
  for (Index k = 0; k < c.cols(); ++k) scratch.y[k] = -scratch.push[k];
  for (Index i = first; i < first + n; ++i) scratch.impulse[i] = weight * scratch.taken[i];
}

void correct(const Impact& impact, double factor, Vector& rate, const ImpactScratch& scratch) {
  const Matrix& x = impact.mass->spread;
  for (Index k = 0; k < x.cols(); ++k) small::add(x.rows(), factor * (scratch.push[k] + scratch.y[k]), x.data() + k * x.rows(), rate.data());
}

void add_impulse(const Impact& impact, double factor, Vector& impulse, const ImpactScratch& scratch) {
  for (Index i = 0; i < impulse.size(); ++i) impulse[i] += factor * (scratch.impulse[i] - impact.velocity_weight * scratch.taken[i]);
}

}  // namespace uplift
