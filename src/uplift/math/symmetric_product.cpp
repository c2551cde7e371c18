#include "uplift/math/symmetric_product.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace uplift {

namespace {

/// `Width` columns at a time, side by side in memory: an entry of A then meets a row of x that is one or two cache lines.
template <int Width>
void add_columns(double factor, const Sparse& a, const Matrix& x, Index first, Matrix& y) {
  using Row = Eigen::Array<double, Width, 1>;
  const Index columns = std::min<Index>(Width, x.cols() - first), n = a.rows();
  thread_local std::vector<double> space;  // kept: new pages for every product would cost as much as the product
  space.resize(static_cast<std::size_t>(Width * n));
  Eigen::Map<Eigen::Array<double, Width, Eigen::Dynamic>> rows(space.data(), Width, n);
  if (columns < Width) rows.setZero();
  for (Index j = 0; j < columns; ++j) rows.row(j) = x.col(first + j).array();
  const int *start = a.outerIndexPtr(), *count = a.innerNonZeroPtr(), *index = a.innerIndexPtr();  // count: null where compressed
  const double* value = a.valuePtr();
  for (Index i = 0; i < n; ++i) {
    Row sum = Row::Zero();
    const int end = count != nullptr ? start[i] + count[i] : start[i + 1];
    for (int k = start[i]; k < end; ++k) sum += value[k] * rows.col(index[k]);
    for (Index j = 0; j < columns; ++j) y(i, first + j) += factor * sum[j];
  }
}

}  // namespace

void add_symmetric_product(double factor, const Sparse& a, const Matrix& x, Matrix& y) {
  assert(a.rows() == a.cols() && a.rows() == x.rows() && y.rows() == x.rows() && y.cols() == x.cols());
  constexpr int narrow = 4, wide = 16;
  for (Index first = 0; first < x.cols(); first += wide)
    x.cols() - first <= narrow ? add_columns<narrow>(factor, a, x, first, y) : add_columns<wide>(factor, a, x, first, y);
}

}  // namespace uplift
