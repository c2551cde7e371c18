#pragma once
#include "uplift/contact/method.h"
#include "uplift/dynamics/bulk.h"

namespace uplift {

/// What the interfaces feel of a bulk that can be solved with but has no factor to take apart (FactorWithReach), in few solves.
///
/// *Compliance.* With B = W V (V: the rows of B, or the touched unknowns, whichever are fewer; columns of V^T are called loads),
///   G = V A^-1 V^T = V A_r^-1 V^T + (V X) (E^T X)^-1 (V X)^T,      X = A^-1 E
/// where E are the unknowns that rows farther apart than twice the reach have in common, as the motions of a rigid raft, and A_r^-1 is the
/// response while they are held. Where K_eff has mass, that of one load dies away with the distance: entries beyond the reach are left out,
/// and loads farther apart than twice the reach share one solve. What is kept of G is made positive semidefinite, = U U^T, and C~ = W U.
///
/// *Correction.* A method solves the interface problem with F~ = C~ C~^T for a free opening c, which gives p and the opening o. The whole
/// bulk under p opens by g; while g is not o, the next free opening is c + (g - o), improved by Anderson's rule from the last ones. It ends
/// with g = o within 1e-10 of what o changes by in the step (of what p closes, where that is less; but not within less than 1e-12 of it),
/// whatever F~ is. Openings are differences of motions that may be far larger: what their round-off takes is not asked for.
class SolvedResponse {
 public:
  /// The factor, B and the counts must stay alive.
  SolvedResponse(const BulkFactor& factor, const Model& model, const Sparse& b, LinearCounts& counts);
  /// C~: rows x loads. Hands it over: `correct` finds it in the problem.
  Matrix take_factor() { return std::move(c_); }
  /// Solves a step: `opening` is gap + B u0. Fills free_opening of the problem, the solution and the increment of the displacement.
  Outcome solve(const Vector& right, const Vector& opening, const ContactMethod& method, MethodWork& work, InterfaceProblem& problem,
                InterfaceSolution& solution, Vector& increment);
  /// The next step does not begin at the last forces.
  void forget();

 private:
  void improve(Vector& free_opening, const Vector& rest);
  void press(const Vector& force, double residual, Vector& increment);

  const BulkFactor& factor_;
  const Sparse& b_;
  BulkWork work_;
  Matrix c_;
  Vector force_;                            // p - D opening of the last solution [N]
  std::vector<Vector> openings_, remains_;  // changes of c and of g - o from one try to the next, the oldest first
  Vector last_opening_, last_rest_;
};

}  // namespace uplift
