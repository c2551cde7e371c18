#include "uplift/reduction/pod.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/linear/blas.h"
#include "uplift/linear/singular_values.h"
#include "uplift/math/dense.h"

namespace uplift {

namespace {

double energy_of(const Matrix& x, const Matrix& product) {
  return std::max(0.0, x.cwiseProduct(product).sum());
}

/// Combinations of the columns of x that are orthonormal in the product, which is given; those smaller than `share` of the largest, or
/// smaller than `least`, are left out.
Matrix combinations(const Matrix& x, const Matrix& product, double share, double least) {
  const Matrix squares = transposed_product(x, product);
  const SymmetricEigen eigen(0.5 * (squares + squares.transpose()));
  const Vector& values = eigen.eigenvalues();
  const double largest = values.size() > 0 ? std::sqrt(std::max(0.0, values.maxCoeff())) : 0;
  const double threshold = std::pow(std::max(share * largest, least), 2);
  const Index count = std::ranges::count_if(values, [&](double value) { return value > threshold; });
  return eigen.eigenvectors().rightCols(count) * values.tail(count).cwiseSqrt().cwiseInverse().asDiagonal();
}

void append_columns(const Matrix& more, Matrix& to) {
  to.conservativeResize(more.rows(), to.cols() + more.cols());
  to.rightCols(more.cols()) = more;
}

}  // namespace

void Pod::remove(const Matrix& added, const Matrix& product, Matrix& x) const {
  for (const Matrix* vectors : {&beside_, &basis_, &added})
    if (vectors->cols() > 0) add_product(-1, *vectors, transposed_product(*vectors, product), x);
}

Pod::Added Pod::beside_basis(Matrix& x, double least) const {
  constexpr double at_once = 1e-5;  // some decades at a time, because squares have half the digits
  constexpr int rounds = 3;
  auto& [product, part, part_product, turned] = *work_;
  Added added{Matrix(x.rows(), 0), Matrix(0, x.cols())};
  for (int round = 0; round < rounds; ++round) {
    if (round > 0) product_.times(x, product);
    const Matrix of_part = combinations(x, product, at_once, least);
    if (of_part.cols() == 0) break;
    part.setZero(x.rows(), of_part.cols());
    add_product(1, x, of_part, part);
    product_.times(part, part_product);
    remove(added.vectors, part_product, part);
    product_.times(part, part_product);
    const Matrix anew = combinations(part, part_product, 0.1, 0);
    turned.setZero(x.rows(), anew.cols());
    add_product(1, part, anew, turned);
    const Matrix coefficients = transposed_product(turned, product);
    add_product(-1, turned, coefficients, x);
    append_columns(turned, added.vectors);
    added.coefficients.conservativeResize(added.vectors.cols(), x.cols());
    added.coefficients.bottomRows(coefficients.rows()) = coefficients;
  }
  return added;
}

void Pod::add(Matrix& x) {
  const Index before = basis_.cols(), columns = x.cols();
  if (x.size() == 0 || x.isZero(0)) return;
  if (before == 0) basis_.resize(x.rows(), 0);
  Matrix &product = work_->product, &turned = work_->turned;
  product_.times(x, product);
  energy_ += energy_of(x, product);
  const Matrix of_basis = transposed_product(basis_, product);
  remove(Matrix(x.rows(), 0), product, x);
  product_.times(x, product);
  const double size = std::hypot(before > 0 ? values_[0] : 0, of_basis.norm(), std::sqrt(energy_of(x, product)));
  // a full basis: what is small beside the last of its directions replaces none of them
  const double least = std::max(least_ * size, before == most_ ? 0.01 * values_[most_ - 1] : 0);
  const Added added = beside_basis(x, least);
  const Index count_added = added.vectors.cols();
  Matrix core = Matrix::Zero(before + count_added, before + columns);
  core.topLeftCorner(before, before) = values_.asDiagonal();
  core.topRightCorner(before, columns) = of_basis;
  core.bottomRightCorner(count_added, columns) = added.coefficients;
  const SingularValues singular(core);
  const double threshold = singular.values().size() > 0 ? least_ * singular.values()[0] : 0;
  const Index count =
      std::min<Index>(most_, std::ranges::count_if(singular.values(), [&](double value) { return value > threshold && value > 0; }));
  const Matrix leading = singular.left().leftCols(count);
  turned.setZero(x.rows(), count);
  add_product(1, basis_, leading.topRows(before), turned);
  add_product(1, added.vectors, leading.bottomRows(count_added), turned);
  basis_.swap(turned);
  values_ = singular.values().head(count);
}

Matrix Pod::release() {
  values_.resize(0);
  return std::exchange(basis_, Matrix());
}

}  // namespace uplift
