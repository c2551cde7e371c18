#include "uplift/math/small_product.h"

#include "uplift/math/fixed.h"

// Apart from small.cpp: Eigen's products of nine sizes take 3 s.
namespace uplift::small {
namespace {

/// y = A x for a square matrix whose size the compiler knows.
template <int N>
void multiply_fixed(const Matrix& a, const double* x, double* y) {
  Eigen::Map<Fixed<N, 1>>(y).noalias() = Eigen::Map<const Fixed<N, N>>(a.data()) * Eigen::Map<const Fixed<N, 1>>(x);
}

}  // namespace

Product product_of(const Matrix& a) {
  if (a.rows() != a.cols()) return multiply_any;
  switch (a.rows()) {
    case 1:
      return multiply_fixed<1>;
    case 2:
      return multiply_fixed<2>;
    case 3:
      return multiply_fixed<3>;
    case 4:
      return multiply_fixed<4>;
    case 5:
      return multiply_fixed<5>;
    case 6:
      return multiply_fixed<6>;
    case 7:
      return multiply_fixed<7>;
    case 8:
      return multiply_fixed<8>;
    case 12:  // two nodes in space
      return multiply_fixed<12>;
    default:
      return multiply_any;
  }
}

}  // namespace uplift::small
