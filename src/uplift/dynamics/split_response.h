#pragma once
#include <utility>

#include "uplift/contact/jumps.h"
#include "uplift/dynamics/bulk.h"

namespace uplift {

/// What the interfaces feel of a bulk whose touched unknowns t were eliminated last, P A P^T = L L^T. With B_t the columns of B for them:
///   B A^-1 B^T = (B_t L_tt^-T) (B_t L_tt^-T)^T,      B_t L_tt^-T = C Q      (LQ factors; C square when there are fewer rows than unknowns)
/// Where rows are more than jumps, as on a cut through hexahedra, B_t = W V^T with one column for a jump, V^T L_tt^-T = R^T Q, C = W R^T.
/// The forward half of a back-solve gives y = L^-1 P r, whose tail y_t is all that the interfaces feel of r: opening += C (Q y_t). When the
/// interface problem is solved, its coordinates go back into the tail, y_t += Q^T z, and the backward half gives the displacement:
/// a condensed step costs one back-solve and keeps nothing that is larger than the interface.
class SplitResponse {
 public:
  /// `factor` must be split, its last unknowns those that `b` touches. It and the counts must stay alive.
  SplitResponse(const BulkFactor& factor, const Sparse& b, LinearCounts& counts);
  const Matrix& factor() const { return c_; }  // C: rows x r
  /// W and L of C = W R^T, L = R^T, where rows are more than jumps.
  const JumpFactor& jumps() const { return jumps_; }
  /// Hands C over, for those who need no forward half.
  Matrix take_factor() { return std::move(c_); }
  /// Forward half for a right-hand side; adds B A^-1 r to `opening`.
  void forward(const Vector& right, Vector& opening);
  /// The same for r = 0.
  void forward_of_nothing(Index unknowns);
  /// x = A^-1 r + the spread of z, with the r of the last forward half.
  void backward(const Vector& z, Vector& x);

 private:
  const BulkFactor& factor_;
  LinearCounts& counts_;
  JumpFactor jumps_;
  Matrix c_, q_;  // q_: r x touched unknowns; empty: the identity
  Vector half_, tail_, jump_;
};

/// The spread of interface forces through a split factor, which must stay alive: C is kept, a product with X is the backward half of a
/// back-solve. What the dense X would take (free x r) is neither made nor streamed.
Spread split_spread(const BulkFactor& factor, const Sparse& b, LinearCounts& counts);

}  // namespace uplift
