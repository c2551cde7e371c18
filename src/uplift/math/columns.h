#pragma once
#include <vector>

#include "uplift/math/linalg.h"

namespace uplift {

/// y += scale * sum over the chosen columns j of A_j x_j; y has A.rows() numbers, x A.cols(). The sum of a row is made in the order of the
/// choice.
void add_columns_of(const Matrix& a, double scale, const std::vector<Index>& chosen, const double* x, double* y);

}  // namespace uplift
