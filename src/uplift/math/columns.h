#pragma once
#include <vector>

#include "uplift/math/linalg.h"

namespace uplift {

/// So many rows fill whole registers. Where the columns of a matrix have as many (zeros below), all of them begin like the first one: a
/// product out of the second-level cache then takes half of the time.
Index whole_registers(Index rows);

/// y += scale * sum over the chosen columns j of A_j x_j; y has A.rows() numbers, x A.cols(). The sum of a row is made in the order of the
/// choice.
void add_columns_of(const Matrix& a, double scale, const std::vector<Index>& chosen, const double* x, double* y);

}  // namespace uplift
