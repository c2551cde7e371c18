#include "uplift/math/partial_lu.h"

#include <utility>

#include "uplift/math/dense.h"

namespace uplift {

void LuInPlace::size(Index most) {
  matrix_.resize(most, most);
  swaps_.assign(static_cast<std::size_t>(most), 0);
}

bool LuInPlace::factorise(Index n) {
  order_ = n;
  if (n == 0) return true;
  int count = 0;
  Eigen::internal::partial_lu_impl<double, Eigen::ColMajor, int>::blocked_lu(n, n, matrix_.data(), matrix_.outerStride(), swaps_.data(),
                                                                             count);
  const auto pivots = matrix_.diagonal().head(n).cwiseAbs();
  // whatever is not finite in the matrix reaches a pivot
  return pivots.allFinite() && pivots.minCoeff() > 1e-14 * pivots.maxCoeff();
}

void LuInPlace::solve(double* x) const {
  for (Index k = 0; k < order_; ++k) std::swap(x[k], x[swaps_[static_cast<std::size_t>(k)]]);
  Map solution(x, order_);
  const auto part = matrix_.topLeftCorner(order_, order_);
  part.triangularView<Eigen::UnitLower>().solveInPlace(solution);
  part.triangularView<upper_triangle>().solveInPlace(solution);
}

}  // namespace uplift
