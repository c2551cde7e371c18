#pragma once
#include <cstddef>

#include "uplift/math/fixed.h"
#include "uplift/math/small.h"

// Apart from small.h: Eigen's products of nine sizes take 3 s of every file that includes this one.
namespace uplift::small {

/// y = A x for a square matrix whose size the compiler knows.
template <int N>
inline void multiply_fixed(const double* a, const double* x, double* y) {
  Eigen::Map<Fixed<N, 1>>(y).noalias() = Eigen::Map<const Fixed<N, N>>(a) * Eigen::Map<const Fixed<N, 1>>(x);
}

/// y = A x, A column-major n x m
inline void multiply(const Matrix& a, const double* x, double* y) {
  const std::ptrdiff_t n = a.rows(), m = a.cols();
  if (n == m) switch (n) {
      case 1:
        return multiply_fixed<1>(a.data(), x, y);
      case 2:
        return multiply_fixed<2>(a.data(), x, y);
      case 3:
        return multiply_fixed<3>(a.data(), x, y);
      case 4:
        return multiply_fixed<4>(a.data(), x, y);
      case 5:
        return multiply_fixed<5>(a.data(), x, y);
      case 6:
        return multiply_fixed<6>(a.data(), x, y);
      case 7:
        return multiply_fixed<7>(a.data(), x, y);
      case 8:
        return multiply_fixed<8>(a.data(), x, y);
      case 12:  // two nodes in space
        return multiply_fixed<12>(a.data(), x, y);
      default:
        break;
    }
  multiply_any(a, x, y);
}

}  // namespace uplift::small
