#pragma once
#include <vector>

#include "uplift/math/linalg.h"

namespace uplift {

/// A P = Q T by modified Gram-Schmidt with column pivoting (Bjorck, BIT 7, 1967), each new direction orthogonalised twice. The work space
/// is sized once for the largest matrix, so that matrices of changing size cost no allocation: an interface under a rigid footing has a few
/// long columns or rows, for which this is also faster than blocked Householder code.
class Orthonormal {
 public:
  /// Room for matrices of at most `rows` x `columns`.
  void size(Index rows, Index columns);
  /// Factors the first `rows` x `columns` of a. Columns whose rest is smaller than `threshold` times the largest column do not count.
  void compute(const Matrix& a, Index rows, Index columns, double threshold);
  Index rank() const { return rank_; }
  /// Q: rows x rank, in the upper left corner.
  const Matrix& basis() const { return basis_; }
  /// x (columns): A x = b in the sense of least squares, x zero in the columns that do not count.
  void solve(const Vector& b, Vector& x);
  /// x (rows): the shortest with A^T x = b, b in the range of A^T.
  void solve_transposed(const Vector& b, Vector& x);

 private:
  Index rows_ = 0, columns_ = 0, rank_ = 0;
  Matrix rest_, basis_, triangle_;
  Vector part_;
  std::vector<Index> pivot_;
};

}  // namespace uplift
