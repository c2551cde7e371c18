#pragma once
#include <algorithm>
#include <cmath>

#include "uplift/math/dense.h"

namespace uplift {

/// The residual of KernelReply.
inline double kernel_residual(const ConstMatrixMap& c, const Vector& z, const double* force, const double* held, const Vector& opening,
                              const double* target) {
  double largest = 0, closed = 0;
  for (Index i = 0; i < c.rows(); ++i) {
    largest = std::max(largest, std::abs(target[i]));
    if (held[i] > 0) closed = std::max(closed, std::abs(opening[i]));
  }
  const double size = z.norm(), balance = size > 0 ? (z + c.transpose() * ConstMap(force, c.rows())).norm() / size : 0;
  return largest > 0 ? std::max(balance, closed / largest) : balance;
}

/// Solves with closed rows A (count x r; rows scaled by the root of their weight), redundant rows allowed:
///   least_norm(b):  the shortest z with A z = b (in the least-squares sense when the rows contradict each other)
///   multipliers(z): the shortest q with A^T q = -z, z being a combination of the rows; refined, so that the balance holds to round-off
/// Cholesky of the smaller of A A^T and A^T A when that is well conditioned, else a complete orthogonal decomposition.
/// Included by sources only.
class HeldRows {
 public:
  explicit HeldRows(const Matrix& a) : a_(a) {
    if (a.rows() == 0) return;
    wide_ = a.rows() <= a.cols();
    gram_.compute(wide_ ? Matrix(a * a.transpose()) : Matrix(a.transpose() * a));
    if (gram_.info() == Success) {
      const auto diagonal = gram_.matrixLLT().diagonal();
      cholesky_ = diagonal.minCoeff() > 1e-4 * diagonal.maxCoeff();
    }
    if (cholesky_) return;
    decomposition_.setThreshold(1e-10);
    decomposition_.compute(a);
  }

  Vector least_norm(const Vector& b) const {
    if (a_.rows() == 0) return Vector::Zero(a_.cols());
    if (!cholesky_) return decomposition_.solve(b);
    if (wide_) return a_.transpose() * gram_.solve(b);
    return gram_.solve(a_.transpose() * b);
  }

  Vector multipliers(const Vector& z) const {
    Vector q = Vector::Zero(a_.rows());
    if (a_.rows() == 0) return q;
    for (int pass = 0; pass < 3; ++pass) q -= transposed(z + a_.transpose() * q);
    return q;
  }

 private:
  /// The shortest q with A^T q = z.
  Vector transposed(const Vector& z) const {
    if (!cholesky_) return decomposition_.transpose().solve(z);
    if (wide_) return gram_.solve(a_ * z);
    return a_ * gram_.solve(z);
  }

  const Matrix& a_;
  bool wide_ = false, cholesky_ = false;
  Cholesky gram_;
  CompleteQr decomposition_;
};

}  // namespace uplift
