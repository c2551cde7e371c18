#pragma once
#include "uplift/math/linalg.h"

namespace uplift {

/// y += factor A x for a symmetric matrix A of which both triangles are stored, and many columns x: A is read once for sixteen of them.
void add_symmetric_product(double factor, const Sparse& a, const Matrix& x, Matrix& y);

}  // namespace uplift
