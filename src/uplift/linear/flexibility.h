#pragma once
#include <vector>

#include "uplift/linear/solver.h"
#include "uplift/math/vibration.h"

// The most flexible shapes of masses on a factored matrix A = K + s M:   A^-1 M x = mu x,   w^2 = 1/mu - s
namespace uplift {

/// Eigenpairs with the largest mu, falling. Shapes are mass-normalised, their largest component is positive.
struct Flexible {
  Vector mu;  // s2/rad2
  Matrix shape;
};

/// All that are asked for, from the dense flexibility of the massive unknowns; for a few hundred of them.
Flexible flexible_dense(const Factor& a, const Sparse& mass, const std::vector<int>& massive, Index count);

/// By Lanczos with the inner product of M, which may be semidefinite. A repeated mu can be found once only: with `repeated` the search is
/// taken up again beside the shapes found until it finds nothing more flexible than the last of them.
Flexible flexible_lanczos(const Factor& a, const Sparse& mass, Index count, bool repeated);

}  // namespace uplift
