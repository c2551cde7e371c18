#pragma once
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <type_traits>

#include "uplift/math/linalg.h"

// Dense factorisations, compiled once: the templates behind them take seconds of every file that uses them.
namespace uplift {

/// One of Eigen's dense factorisations of a matrix A. What it offers beside the solution (pivots, factors, thresholds) stands behind `->`.
template <class Kind>
class Factored {
 public:
  Factored() = default;
  explicit Factored(const Matrix& a) { compute(a); }
  void compute(const Matrix& a);
  /// A x = b, or the shortest x with the least residual (CompleteQr).
  template <class Right>
  auto solve(const Eigen::MatrixBase<Right>& b) const {
    std::conditional_t<Right::ColsAtCompileTime == 1, Vector, Matrix> x(kind_.cols(), b.cols());
    solve(b.derived(), x);
    return x;
  }
  /// The same into an x that has its size already: without allocation.
  void solve(const Vector& b, Vector& x) const;
  void solve(const Eigen::Ref<const Matrix>& b, Eigen::Ref<Matrix> x) const;
  Kind* operator->() { return &kind_; }
  const Kind* operator->() const { return &kind_; }

 private:
  Kind kind_;
};

using Cholesky = Factored<Eigen::LLT<Matrix>>;
using PivotedLdlt = Factored<Eigen::LDLT<Matrix>>;
using PartialLu = Factored<Eigen::PartialPivLU<Matrix>>;
using Qr = Factored<Eigen::HouseholderQR<Matrix>>;
using PivotedQr = Factored<Eigen::ColPivHouseholderQR<Matrix>>;
using CompleteQr = Factored<Eigen::CompleteOrthogonalDecomposition<Matrix>>;
using Eigen::Success;

/// The first columns of Q.
Matrix columns_of_q(const Qr&, Index count);
Matrix columns_of_q(const PivotedQr&, Index count);

/// A^-1 of a square, regular matrix.
Matrix inverse(const Matrix&);
/// B U^-1 with A = L U, U = L^T.
Matrix divided_by_upper(const Cholesky&, const Matrix& b);

/// A x = lambda x of a symmetric matrix (its lower triangle is read): eigenvalues ascending, eigenvectors of length one.
class SymmetricEigen {
 public:
  explicit SymmetricEigen(const Matrix& a);
  const Vector& eigenvalues() const { return values_; }
  const Matrix& eigenvectors() const { return vectors_; }

 private:
  Vector values_;
  Matrix vectors_;
};

/// A x = lambda B x; A symmetric, B symmetric and positive definite: eigenvalues ascending, eigenvectors with x^T B x = 1.
class GeneralisedEigen {
 public:
  GeneralisedEigen(const Matrix& a, const Matrix& b);
  const Vector& eigenvalues() const { return values_; }
  const Matrix& eigenvectors() const { return vectors_; }

 private:
  Vector values_;
  Matrix vectors_;
};

}  // namespace uplift
