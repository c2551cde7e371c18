#pragma once
#include <vector>

#include "uplift/math/linalg.h"

namespace uplift {

/// Two symmetric matrices of the same size, kept as one lower triangle with both values side by side: the products that every step needs
/// (stiffness times displacement, mass times velocity) in one pass over memory, with half the values and a quarter of the indices.
class SymmetricPair {
 public:
  SymmetricPair() = default;
  SymmetricPair(const Sparse& a, const Sparse& b);
  /// ax = A x, by = B y; the results must have the right size and differ from x and y.
  void multiply(const Vector& x, const Vector& y, Vector& ax, Vector& by) const;

 private:
  struct Two {
    double a, b;
  };
  std::vector<int> start_, column_;  // rows of the strict lower triangle
  std::vector<Two> value_, diagonal_;
};

}  // namespace uplift
