#include "uplift/math/dense.h"

#include <Eigen/Eigenvalues>

namespace uplift {

template <class Kind>
void Factored<Kind>::compute(const Matrix& a) {
  kind_.compute(a);
}

template <class Kind>
void Factored<Kind>::solve(const Vector& b, Vector& x) const {
  x = kind_.solve(b);
}

template <class Kind>
void Factored<Kind>::solve(const Eigen::Ref<const Matrix>& b, Eigen::Ref<Matrix> x) const {
  x = kind_.solve(b);
}

template class Factored<Eigen::LLT<Matrix>>;
template class Factored<Eigen::LDLT<Matrix>>;
template class Factored<Eigen::PartialPivLU<Matrix>>;
template class Factored<Eigen::HouseholderQR<Matrix>>;
template class Factored<Eigen::ColPivHouseholderQR<Matrix>>;
template class Factored<Eigen::CompleteOrthogonalDecomposition<Matrix>>;

Matrix columns_of_q(const Qr& qr, Index count) {
  return qr->householderQ() * Matrix::Identity(qr->rows(), count);
}

Matrix columns_of_q(const PivotedQr& qr, Index count) {
  return qr->householderQ() * Matrix::Identity(qr->rows(), count);
}

Matrix inverse(const Matrix& a) {
  return a.inverse();
}

Matrix divided_by_upper(const Cholesky& cholesky, const Matrix& b) {
  return cholesky->matrixU().solve<Eigen::OnTheRight>(b);
}

SymmetricEigen::SymmetricEigen(const Matrix& a) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(a);
  values_ = solver.eigenvalues();
  vectors_ = solver.eigenvectors();
}

GeneralisedEigen::GeneralisedEigen(const Matrix& a, const Matrix& b) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver(a, b);
  values_ = solver.eigenvalues();
  vectors_ = solver.eigenvectors();
}

}  // namespace uplift
