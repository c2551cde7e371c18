#include "uplift/contact/orthonormal.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "uplift/math/small.h"

namespace uplift {

void Orthonormal::size(Index rows, Index columns) {
  if (rest_.rows() >= rows && rest_.cols() >= columns) return;
  const Index least = std::min(rows, columns);
  rest_.setZero(rows, columns);
  basis_.setZero(rows, least);
  triangle_.setZero(least, columns);
  part_.setZero(least);
  pivot_.resize(static_cast<std::size_t>(columns));
}

void Orthonormal::compute(const Matrix& a, Index rows, Index columns, double threshold) {
  rows_ = rows, columns_ = columns, rank_ = 0;
  rest_.topLeftCorner(rows, columns) = a.topLeftCorner(rows, columns);
  std::iota(pivot_.begin(), pivot_.begin() + columns, Index{0});
  double least = 0;
  for (Index k = 0; k < std::min(rows, columns); ++k) {
    Index best = k;
    double largest = -1;
    for (Index j = k; j < columns; ++j) {
      const double size = small::sum_of_squares(rows, rest_.col(j).data());
      if (size > largest) largest = size, best = j;
    }
    const double size = std::sqrt(largest);
    if (k == 0) least = threshold * size;
    if (!(size > least)) return;
    if (best != k) {
      rest_.col(k).head(rows).swap(rest_.col(best).head(rows));
      triangle_.col(k).head(k).swap(triangle_.col(best).head(k));
      std::swap(pivot_[static_cast<std::size_t>(k)], pivot_[static_cast<std::size_t>(best)]);
    }
    double* q = basis_.col(k).data();
    std::copy_n(rest_.col(k).data(), rows, q);
    for (Index i = 0; i < k; ++i) small::add(rows, -small::dot(rows, basis_.col(i).data(), q), basis_.col(i).data(), q);
    const double scale = 1 / std::sqrt(small::sum_of_squares(rows, q));
    for (Index i = 0; i < rows; ++i) q[i] *= scale;
    for (Index j = k; j < columns; ++j) {
      const double share = small::dot(rows, q, rest_.col(j).data());
      triangle_(k, j) = share;
      small::add(rows, -share, q, rest_.col(j).data());
    }
    rank_ = k + 1;
  }
}

void Orthonormal::solve(const Vector& b, Vector& x) {
  for (Index k = 0; k < rank_; ++k) part_[k] = small::dot(rows_, basis_.col(k).data(), b.data());
  for (Index k = rank_; k-- > 0;) {
    part_[k] /= triangle_(k, k);
    small::add(k, -part_[k], triangle_.col(k).data(), part_.data());
  }
  std::fill_n(x.data(), columns_, 0.0);
  for (Index k = 0; k < rank_; ++k) x[pivot_[static_cast<std::size_t>(k)]] = part_[k];
}

void Orthonormal::solve_transposed(const Vector& b, Vector& x) {
  std::fill_n(x.data(), rows_, 0.0);
  for (Index k = 0; k < rank_; ++k) {
    const double known = small::dot(k, triangle_.col(k).data(), part_.data());
    part_[k] = (b[pivot_[static_cast<std::size_t>(k)]] - known) / triangle_(k, k);
    small::add(rows_, part_[k], basis_.col(k).data(), x.data());
  }
}

}  // namespace uplift
