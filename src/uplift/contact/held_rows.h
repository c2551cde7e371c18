#pragma once
#include "uplift/contact/orthonormal.h"
#include "uplift/math/linalg.h"

namespace uplift {

/// Solves with closed rows A (count x r; rows scaled by the root of their weight), redundant rows allowed:
///   least_norm(b):  the shortest z with A z = b (in the least-squares sense when the rows contradict each other)
///   multipliers(z): the shortest q with A^T q = -z, z being a combination of the rows; refined, so that the balance holds to round-off
/// Cholesky of the smaller of A A^T and A^T A when that is well conditioned, else orthonormal bases of both ranges. Vectors of rows may be
/// longer than `count`: only their beginning is used. Nothing is allocated after the first call of `size`.
class HeldRows {
 public:
  /// Room for at most `most` rows of r entries.
  void size(Index most, Index r);
  /// Row k of A is column k of this matrix, to be filled before `compute`.
  Matrix& transposed() { return transposed_; }
  void compute(Index count);
  void least_norm(const Vector& b, Vector& z);
  void multipliers(const Vector& z, Vector& q);

 private:
  void add_transposed(double factor, const Vector& z, Vector& q);
  void solve_gram(Vector& x) const;

  Index most_ = -1, r_ = 0, count_ = 0, order_ = 0;
  bool wide_ = false, cholesky_ = false;
  Matrix transposed_, gram_;
  Orthonormal range_, image_;  // of A^T, and of A on that range
  Matrix product_;             // A times the basis of the range
  Vector rest_, part_, push_;
};

}  // namespace uplift
