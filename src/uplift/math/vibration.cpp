#include "uplift/math/vibration.h"

#include <algorithm>
#include <cmath>

#include "uplift/math/dense.h"

namespace uplift {

namespace {

/// Diagonal scaling to ones (zero stays zero), which makes pivots of different units comparable.
Vector unit_scale(const Matrix& a) {
  Vector scale(a.rows());
  for (Index i = 0; i < a.rows(); ++i) scale[i] = a(i, i) > 0 ? 1 / std::sqrt(a(i, i)) : 0;
  return scale;
}

/// Scaled Cholesky factorisation of A with the test that its pivots are more than round-off.
struct ScaledCholesky {
  explicit ScaledCholesky(const Matrix& a) : scale(unit_scale(a)), factor(scale.asDiagonal() * a * scale.asDiagonal()) {
    regular = a.rows() == 0 || (scale.minCoeff() > 0 && factor->info() == Success && factor->matrixLLT().diagonal().minCoeff() > 1e-7);
  }
  Matrix solve(const Matrix& b) const { return scale.asDiagonal() * factor.solve(scale.asDiagonal() * b); }
  Vector scale;
  Cholesky factor;
  bool regular = false;
};

Vibration with_shift(const ScaledCholesky& a, const Matrix& root, double shift, int count) {
  const Matrix spread = a.solve(root);
  Matrix flexibility = root.transpose() * spread;
  flexibility = ((flexibility + flexibility.transpose()) / 2).eval();
  const SymmetricEigen eigen(flexibility);
  const Index size = root.cols(), found = std::min<Index>(count, size);
  Vibration result{Vector(found), Matrix(root.rows(), found)};
  for (Index i = 0; i < found; ++i) {
    const double mu = eigen.eigenvalues()[size - 1 - i];
    result.omega_squared[i] = 1 / mu - shift;
    Vector shape = spread * eigen.eigenvectors().col(size - 1 - i) / mu;
    Index largest = 0;
    shape.cwiseAbs().maxCoeff(&largest);
    result.shape.col(i) = shape[largest] < 0 ? Vector(-shape) : shape;
  }
  return result;
}

}  // namespace

Matrix semidefinite_root(const Matrix& a) {
  const Vector scale = unit_scale(a);
  const PivotedLdlt ldlt(scale.asDiagonal() * a * scale.asDiagonal());
  const Vector pivots = ldlt->vectorD();
  Matrix lower = ldlt->matrixL();
  Index rank = 0;
  while (rank < pivots.size() && pivots[rank] > 1e-12) ++rank;  // LDLT of a semidefinite matrix sorts its pivots
  Matrix root = lower.leftCols(rank) * pivots.head(rank).cwiseSqrt().asDiagonal();
  root = (ldlt->transpositionsP().transpose() * root).eval();
  for (Index i = 0; i < a.rows(); ++i) root.row(i) *= scale[i] > 0 ? 1 / scale[i] : 0;
  return root;
}

Vibration vibration(const Matrix& stiffness, const Matrix& mass, int count) {
  const Matrix root = semidefinite_root(mass);
  if (root.cols() == 0) return {};
  const ScaledCholesky unshifted(stiffness);
  if (unshifted.regular) return with_shift(unshifted, root, 0, count);

  // Rigid motions. First guess: the smallest Rayleigh quotient of a single unknown, an upper bound of the first elastic w^2; not one that
  // round-off has left of terms like the others.
  constexpr double round_off = 1e-14;  // of the largest
  double shift = 0, largest = 0;
  const auto quotient = [&](Index i) { return mass(i, i) > 0 ? stiffness(i, i) / mass(i, i) : 0; };
  for (Index i = 0; i < mass.rows(); ++i) largest = std::max(largest, quotient(i));
  for (Index i = 0; i < mass.rows(); ++i)
    if (const double here = quotient(i); here > round_off * largest && (shift == 0 || here < shift)) shift = here;
  if (shift == 0) shift = 1;
  constexpr double rigid = 1e-7;  // of the shift: below it w^2 is round-off
  Vibration result;
  for (int pass = 0; pass < 12; ++pass) {
    const ScaledCholesky shifted(stiffness + shift * mass);
    if (!shifted.regular) {
      shift *= 1e3;  // it was made of the round-off of K; or a massless mechanism, which no shift helps
      continue;
    }
    result = with_shift(shifted, root, shift, static_cast<int>(root.cols()));
    double first = 0;
    for (Index i = 0; i < result.omega_squared.size() && first == 0; ++i)
      if (result.omega_squared[i] > rigid * shift) first = result.omega_squared[i];
    const bool settled = first == 0 || first > 1e-3 * shift;
    if (settled) break;
    shift = first;
  }
  for (double& value : result.omega_squared)
    if (value <= rigid * shift) value = 0;
  const Index found = std::min<Index>(count, result.omega_squared.size());
  return {result.omega_squared.head(found), result.shape.leftCols(found)};
}

}  // namespace uplift
