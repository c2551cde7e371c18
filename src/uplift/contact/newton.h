#pragma once
#include "uplift/contact/problem.h"

// Newton's method on the traction laws of an interface problem. The unknowns are the coordinates z:
//     G(z) = z + C^T (p(opening) - D opening) = 0        opening = free_opening + C z
//     H = I + C^T (dp/d opening - D) C
// For laws that do not soften the step is the minimum of a convex function whose gradient is G, so that a line search along the Newton
// direction d on the directional derivative d . G makes it globally convergent (THEORY section 6).
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

/// Solves in place from the guess in `solution.z`; fills opening, force, now.
Outcome solve_by_newton(const InterfaceProblem&, const AugmentedForce&, const NewtonOptions&, InterfaceSolution&);

/// Forces, and slopes when wanted, at solution.z: fills opening, force, now and the scratch's slope.
void evaluate(const InterfaceProblem&, const AugmentedForce&, bool with_slope, InterfaceSolution&);

/// Force on the rows that a law gives at the end of the step [N], not scaled: area * t(opening).
void end_forces(const InterfaceProblem&, const InterfaceSolution&, Vector& force, std::vector<double>& scratch_history);

}  // namespace uplift
