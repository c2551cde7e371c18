#pragma once
#include <vector>

#include "uplift/math/linalg.h"

namespace uplift {

/// P A = L U of square matrices whose size changes from one factorisation to the next without new memory (Eigen's class would allocate;
/// here its products have work space of their own beyond order 512).
class LuInPlace {
 public:
  /// Room for matrices of order `most`.
  void size(Index most);
  /// Column j of A, to be filled before `factorise`, which overwrites it and some numbers beyond it.
  double* column(Index j) { return matrix_.col(j).data(); }
  /// Factorises the first n rows and columns; false when A is singular to working precision or not finite.
  bool factorise(Index n);
  /// A x = b in place.
  void solve(double* x) const;
  void solve(Matrix& x) const;

 private:
  void factorise_block(Index from, Index end);
  void follow_block(Index from, Index end);

  Index order_ = 0;
  Matrix matrix_;
  std::vector<int> swaps_;  // of rows, in their order
};

}  // namespace uplift
