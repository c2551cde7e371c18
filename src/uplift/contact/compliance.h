#pragma once
#include "uplift/linear/solver.h"
#include "uplift/math/linalg.h"

namespace uplift {

/// How forces on the interface rows spread through a factored symmetric matrix A (K_eff, M, ...):
///   A^-1 B^T = spread * factor^T         B A^-1 B^T = factor * factor^T   (the compliance, never inverted)
/// with r = rank of B, the least that is possible: at most three for a rigid footing in 2D, whatever its number of joints.
struct Spread {
  Matrix factor;  // rows x r
  Matrix spread;  // free x r
};

/// One block of r right-hand sides through the factor; `b` is rows x free.
///
/// B = W V^T with r columns each, in the cheaper of three exact ways: V = the touched unknowns (a footing with many joints), W = the
/// identity (independent rows), or both from a rank-revealing QR. Then with G = V^T A^-1 V = L L^T, positive definite even where the
/// compliance is singular,  factor = W L  and  spread = A^-1 V L^-T.
Spread spread_through(const Factor& a, const Sparse& b);

}  // namespace uplift
