#pragma once
#include "uplift/contact/problem.h"

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

/// Stiffness of every row for the augmentation [N/m]: factor / F_ii, of the whole interface where a row has no compliance. The tangential
/// rows of a point share that of their mean compliance: the trial force must not turn.
void augmentation(const InterfaceProblem&, double factor, Vector& stiffness);

struct NewtonOptions {
  double tolerance = 1e-12;  // |G| relative to |z| + |C^T p|
  int most_iterations = 60;
};

/// Iterations after which the search turns from the potential to the residual, and round-off counts as converged.
inline constexpr int patience_of_newton = 12;

/// Solves in place from the guess in `solution.z`; fills opening, force, now.
Outcome solve_by_newton(const InterfaceProblem&, const AugmentedForce&, const NewtonOptions&, InterfaceSolution&);

/// Up to so many coordinates the Newton matrix is formed and solved by plain loops; beyond, see newton_many.h.
inline constexpr int few = 12;

/// Gives what follows its sizes; does nothing when they are right.
void size_newton(const InterfaceProblem&, InterfaceSolution&);

/// Forces, and slopes when wanted, at solution.z: fills opening, force, now and the scratch's slope, all of the right size.
void evaluate(const InterfaceProblem&, const AugmentedForce&, bool with_slope, InterfaceSolution&);

}  // namespace uplift
