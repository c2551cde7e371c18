#include "uplift/math/symmetric_pair.h"

#include <algorithm>
#include <cassert>

namespace uplift {

SymmetricPair::SymmetricPair(const Sparse& a, const Sparse& b) {
  assert(a.rows() == b.rows() && a.rows() == a.cols());
  // a column of the upper triangle is a row of the lower one; the two patterns are merged
  const Index n = a.rows();
  diagonal_.assign(static_cast<std::size_t>(n), {0, 0});
  start_.assign(1, 0);
  start_.reserve(static_cast<std::size_t>(n) + 1);
  const auto least = static_cast<std::size_t>(std::max({a.nonZeros(), b.nonZeros(), n}) - n) / 2;  // a list that grows is there twice
  column_.reserve(least);
  value_.reserve(least);
  for (Index row = 0; row < n; ++row) {
    Sparse::InnerIterator in_a(a, row), in_b(b, row);
    while ((in_a && in_a.row() <= row) || (in_b && in_b.row() <= row)) {
      const Index of_a = in_a && in_a.row() <= row ? in_a.row() : n, of_b = in_b && in_b.row() <= row ? in_b.row() : n;
      const Index column = std::min(of_a, of_b);
      const Two both{of_a == column ? in_a.value() : 0, of_b == column ? in_b.value() : 0};
      if (of_a == column) ++in_a;
      if (of_b == column) ++in_b;
      if (column == row) {
        diagonal_[static_cast<std::size_t>(row)] = both;
        continue;
      }
      column_.push_back(static_cast<int>(column));
      value_.push_back(both);
    }
    start_.push_back(static_cast<int>(column_.size()));
  }
}

void SymmetricPair::multiply(const Vector& x, const Vector& y, Vector& ax, Vector& by) const {
  const int n = static_cast<int>(diagonal_.size());
  double *to_a = ax.data(), *to_b = by.data();
  const double *from_a = x.data(), *from_b = y.data();
  const Two* value = value_.data();
  const int* column = column_.data();
  for (int i = 0; i < n; ++i) {
    const double xi = from_a[i], yi = from_b[i];
    double sum_a = diagonal_[static_cast<std::size_t>(i)].a * xi, sum_b = diagonal_[static_cast<std::size_t>(i)].b * yi;
    for (int k = start_[static_cast<std::size_t>(i)]; k < start_[static_cast<std::size_t>(i) + 1]; ++k) {
      const int j = column[k];  // j < i: its result is begun already
      sum_a += value[k].a * from_a[j];
      sum_b += value[k].b * from_b[j];
      to_a[j] += value[k].a * xi;
      to_b[j] += value[k].b * yi;
    }
    to_a[i] = sum_a;
    to_b[i] = sum_b;
  }
}

}  // namespace uplift
