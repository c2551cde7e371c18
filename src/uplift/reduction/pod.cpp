#include "uplift/reduction/pod.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/math/dense.h"
#include "uplift/math/singular_values.h"

namespace uplift {

namespace {

/// Columns of x (a part of them) as combinations that are orthonormal in the product; those smaller than `share` of the largest are left
/// out.
Matrix combined(const EnergyProduct& product, const Matrix& x, double share, double& largest) {
  const Matrix squares = x.transpose() * product.times(x);
  const SymmetricEigen eigen(0.5 * (squares + squares.transpose()));
  const Vector& values = eigen.eigenvalues();
  largest = values.size() > 0 ? std::sqrt(std::max(0.0, values.maxCoeff())) : 0;
  const double threshold = share * share * largest * largest;
  const Index count = std::ranges::count_if(values, [&](double value) { return value > threshold; });
  return x * (eigen.eigenvectors().rightCols(count) * values.tail(count).cwiseSqrt().cwiseInverse().asDiagonal());
}

/// The orthonormal basis q and what the columns of x have beside it, down to a size `least`: some decades at a time, because squares have
/// half the digits.
Matrix extended(const EnergyProduct& product, Matrix q, Matrix x, double least) {
  constexpr double at_once = 1e-5;
  constexpr int rounds = 3;
  double now = 0, one = 0;
  for (int round = 0; round < rounds && x.cols() > 0; ++round) {
    for (int pass = 0; pass < 2; ++pass) x -= q * (q.transpose() * product.times(x));
    Matrix part = combined(product, x, at_once, now);
    if (part.cols() == 0 || !(now > least)) break;
    part -= q * (q.transpose() * product.times(part));
    part = combined(product, part, 0.1, one);
    q.conservativeResize(q.rows(), q.cols() + part.cols());
    q.rightCols(part.cols()) = part;
  }
  return q;
}

}  // namespace

void Pod::add(const Matrix& displacements) {
  const Index before = basis_.cols();
  if (displacements.size() == 0 || displacements.isZero(0)) return;
  const double size =
      std::hypot(before > 0 ? values_[0] : 0, std::sqrt(std::max(0.0, displacements.cwiseProduct(product_.times(displacements)).sum())));
  const Matrix both = extended(product_, basis_, displacements, least_ * size);
  const Index added = both.cols() - before;
  Matrix core = Matrix::Zero(before + added, before + displacements.cols());
  core.topLeftCorner(before, before) = values_.asDiagonal();
  core.rightCols(displacements.cols()) = both.transpose() * product_.times(displacements);
  const SingularValues singular(core);
  const double threshold = singular.values().size() > 0 ? least_ * singular.values()[0] : 0;
  const Index count =
      std::min<Index>(most_, std::ranges::count_if(singular.values(), [&](double value) { return value > threshold && value > 0; }));
  basis_ = both * singular.left().leftCols(count);
  values_ = singular.values().head(count);
}

}  // namespace uplift
