#include "uplift/reduction/pod.h"

#include <algorithm>

#include "uplift/math/dense.h"
#include "uplift/math/singular_values.h"

namespace uplift {

namespace {

/// x = q r with q orthonormal in the product; directions below `least` of the largest one are left out. The second pass makes up for what
/// the squares of the first one lose.
void orthonormalise(const EnergyProduct& product, double least, Matrix& x, Matrix& r) {
  r = Matrix::Identity(x.cols(), x.cols());
  for (int pass = 0; pass < 2; ++pass) {
    if (x.cols() == 0) return;
    const Matrix squares = x.transpose() * product.times(x);
    const SymmetricEigen eigen(0.5 * (squares + squares.transpose()));
    const Vector& values = eigen.eigenvalues();
    const double threshold = std::max(pass == 0 ? least * least : 0.0, 1e-14) * values.maxCoeff();
    const Index count = std::ranges::count_if(values, [&](double value) { return value > threshold && value > 0; });
    const Matrix taken = eigen.eigenvectors().rightCols(count);
    const Vector size = values.tail(count).cwiseSqrt();
    x = (x * (taken * size.cwiseInverse().asDiagonal())).eval();
    r = (size.asDiagonal() * (taken.transpose() * r)).eval();
  }
}

}  // namespace

void Pod::add(Matrix displacements) {
  const Index before = basis_.cols();
  Matrix coordinates = Matrix::Zero(before, displacements.cols()), rest;
  for (int pass = 0; pass < 2 && before > 0; ++pass) {
    const Matrix part = basis_.transpose() * product_.times(displacements);
    displacements -= basis_ * part;
    coordinates += part;
  }
  orthonormalise(product_, least_, displacements, rest);
  const Index added = displacements.cols();
  Matrix core = Matrix::Zero(before + added, before + rest.cols());
  core.topLeftCorner(before, before) = values_.asDiagonal();
  core.topRightCorner(before, rest.cols()) = coordinates;
  core.bottomRightCorner(added, rest.cols()) = rest;
  const SingularValues singular(core);
  const double threshold = singular.values().size() > 0 ? least_ * singular.values()[0] : 0;
  const Index count =
      std::min<Index>(most_, std::ranges::count_if(singular.values(), [&](double value) { return value > threshold && value > 0; }));
  Matrix both(basis_.rows(), before + added);
  both << basis_, displacements;
  basis_ = both * singular.left().leftCols(count);
  values_ = singular.values().head(count);
}

}  // namespace uplift
