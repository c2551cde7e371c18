#pragma once
#include "uplift/math/linalg.h"

// Small matrices whose size the compiler knows: they live on the stack.
namespace uplift {

template <int Rows, int Columns>
using Fixed = Eigen::Matrix<double, Rows, Columns>;
using Mat3 = Fixed<3, 3>;
using Vec6 = Fixed<6, 1>;
using Mat6 = Fixed<6, 6>;

}  // namespace uplift
