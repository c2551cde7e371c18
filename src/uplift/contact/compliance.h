#pragma once
#include <memory>

#include "uplift/linear/solver.h"
#include "uplift/math/linalg.h"

namespace uplift {

/// Multiplies with the spread X of interface forces where it is too large to be kept.
class Spreader {
 public:
  virtual ~Spreader() = default;
  /// x += scale X z
  virtual void add(double scale, const Vector& z, Vector& x) const = 0;
};

/// How forces on the interface rows spread through a factored symmetric matrix A (K_eff, M, ...):
///   A^-1 B^T = X C^T         B A^-1 B^T = C C^T   (the compliance, never inverted)
/// with r = rank of B, the least that is possible: at most three for a rigid footing in the plane, six in space, whatever its number of
/// joints.
struct Spread {
  Matrix factor;                                 // C: rows x r
  Matrix spread;                                 // X: free x r; not there when `through` is
  std::shared_ptr<const Spreader> through = {};  // r may then be more than the rank of B
  /// x += scale X z
  void add(double scale, const Vector& z, Vector& x) const;
};

/// One block of r right-hand sides through the factor; `b` is rows x free.
///
/// B = W V^T with r columns each, in the cheaper of three exact ways: V = the touched unknowns (a footing with many joints), W = the
/// identity (independent rows), or both from a rank-revealing QR. Then with G = V^T A^-1 V = L L^T, positive definite even where the
/// compliance is singular,  factor = W L  and  spread = A^-1 V L^-T.
Spread spread_through(const Factor& a, const Sparse& b);

}  // namespace uplift
