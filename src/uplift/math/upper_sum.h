#pragma once
#include <span>

#include "uplift/math/linalg.h"

namespace uplift {

/// A matrix and what it is multiplied by.
struct Term {
  double factor;
  const Sparse& matrix;
};

/// The upper triangle of a sum of symmetric matrices of one size; of each the upper triangle is read. The whole sum and
/// partial sums are never made: nothing is kept beside the result.
Sparse upper_sum(std::span<const Term> terms);

/// The same of any matrices, whole.
Sparse whole_sum(std::span<const Term> terms);

}  // namespace uplift
