#pragma once
#include "uplift/contact/method.h"
#include "uplift/laws/fused.h"

// Newton's method on the traction laws of an interface problem. The unknowns are the coordinates z:
//     G(z) = z + C^T (p(opening) - D opening) = 0        opening = free_opening + C z
//     H = I + C^T (dp/d opening - D) C
// For laws that do not soften the step is the minimum of a convex function whose gradient is G, so that a line search along the Newton
// direction d on the directional derivative d . G makes it globally convergent (docs/theory, section 4).
namespace uplift {

/// Multipliers of the augmented Lagrangian: the force of cone blocks is P(multiplier + stiffness * (opening - origin)), the origin being
/// zero in the normal and the opening at the beginning of the step in the tangential components. Without it a problem must have law blocks
/// only.
struct AugmentedForce {
  const Vector* multiplier = nullptr;  // rows [N]
  const Vector* stiffness = nullptr;   // rows [N/m]
};

struct NewtonOptions {
  double tolerance = 1e-12;  // |G| relative to |z| + |C^T p|
  int most_iterations = 60;
};

/// What the joint filter adds to the first guess of a step from the one before, up to three coordinates: the coefficient c and the lag d_f
/// (laws/filter.h) summed over the points. While no point changes its branch, c stays and d_f <- a d_f + (1 - a) C moved
/// with the pole a of the scheme (docs/theory, section 3).
struct FilterSums {
  double lag[3] = {};        // C^T (scale area c d_f) [sqrt(J)]
  double stiffness[9] = {};  // C^T (scale area c) C
  double moved[3] = {};      // coordinates of the opening increment of the last step [sqrt(J)]
};

/// Work space of Newton's method, sized for one model.
struct NewtonWork final : MethodWork {
  SeenModel model;
  FusedEvaluation evaluation;  // laid out for the problem and the solution of the last call, where it can be fused
  Vector slope;                // per block (components x components x points), blocks one after another [N/m]
  std::vector<int> first_slope;
  Vector gradient, direction, origin;
  Vector pull;  // rows: k times one column of C, of one block; in the units of slope times those of the factor
  Matrix hessian;
  Vector jump;           // of the jumps, where C = W L
  Vector end_pull;       // C^T (scale area end_traction) [sqrt(J)], of a fused solution
  FilterSums filter;     // with a joint filter, of a fused solution
  bool follows = false;  // the next step may be guessed from this one: slope, hessian and the solution's end_traction are converged
  bool bent = false;     // then: some law bent in this one, so that slope and hessian are not those of the next
  std::unique_ptr<MethodWork> direction_of_many;  // more than twelve coordinates
  std::unique_ptr<MethodWork> rows;               // newton/row_newton.h, where it suits
};

/// Iterations after which the search turns from the potential to the residual, and round-off counts as converged.
inline constexpr int patience_of_newton = 12;

/// Solves in place from the guess in `solution.z`; fills opening, force, now.
Outcome solve_by_newton(const InterfaceProblem&, const AugmentedForce&, const NewtonOptions&, NewtonWork&, InterfaceSolution&);

/// Up to so many coordinates the Newton matrix is formed and solved by plain loops; beyond, see newton/many.h.
inline constexpr int few = 12;

/// Sizes the work space and the results for a problem; does nothing when they fit.
void size_newton(const InterfaceProblem&, NewtonWork&, InterfaceSolution&);

/// Forces, and slopes when wanted, at solution.z: fills the results of the path and the slope of the work space, all of the right size.
void evaluate(const InterfaceProblem&, const AugmentedForce&, bool with_slope, NewtonWork&, InterfaceSolution&);
/// The same at solution.opening.
void evaluate_laws(const InterfaceProblem&, const AugmentedForce&, bool with_slope, NewtonWork&, InterfaceSolution&);

}  // namespace uplift
