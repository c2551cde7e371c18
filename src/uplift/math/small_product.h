#pragma once
#include "uplift/math/linalg.h"

// Products of small matrices, for those who multiply often: the size is looked at once.
namespace uplift::small {

/// y = A x of any size
void multiply_any(const Matrix& a, const double* x, double* y);

/// y = A x, A symmetric, of which the upper triangle is read: half of the traffic where the matrix does not fit into the first cache
void multiply_symmetric(const Matrix& a, const double* x, double* y);

/// y = A x
using Product = void (*)(const Matrix& a, const double* x, double* y);

/// The fastest product of matrices of this size.
Product product_of(const Matrix& a);

}  // namespace uplift::small
