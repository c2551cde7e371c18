#pragma once
#include <algorithm>
#include <optional>

#include "uplift/contact/method.h"

// Lagrange multipliers: the constraints of the cone blocks hold exactly, law blocks keep their traction law in the same problem.
//   frictionless, no law, no shift: one quadratic problem in z (kernel.h)
//   frictionless with laws or the statics' shift: a sequence of such problems with the slope of the laws in the Hessian and a line search
//   with friction: semismooth Newton on the contact status (Alart & Curnier, CMAME 92, 1991)
namespace uplift {

struct LagrangeOptions {
  std::optional<double> gap_tolerance;  // m: a point is closed only below minus this, and stays open when it just touches
  double tolerance = 1e-12;             // balance residual, relative
  int most_iterations = 100;
  /// m: gap_tolerance; absent: 1e-12 of the size of the interfaces, or less with a smaller tolerance.
  double gap_of(const ContactModel& model) const { return gap_tolerance.value_or(std::min(tolerance, no_gap) * model.size); }
};

/// Frictionless cones with traction laws and the statics' shift beside them: minimises
///   |z|^2/2 - opening . D opening / 2 + potential of the laws     opening_n >= 0 on the cones
/// by sequential quadratic programming. Globally convergent when the laws do not soften. `work` is made at the first call.
Outcome solve_frictionless(const InterfaceProblem&, const LagrangeOptions&, std::unique_ptr<MethodWork>& work, InterfaceSolution&);

/// Cones with Coulomb friction: p_n <= 0, |p_t| <= -mu p_n, p_t along the slip opening_t - from_t (maximum dissipation), laws and shift
/// beside them. When the status repeats, one point at a time changes (least index first); when that ends without an answer, augmented
/// Lagrangian updates give the status, from which the exact solve is tried again. Redundant points share the force at the end. `work` is
/// made at the first call.
Outcome solve_frictional(const InterfaceProblem&, const LagrangeOptions&, std::unique_ptr<MethodWork>& work, InterfaceSolution&);

/// When the iterations may stop: below the tolerance, or where the residual is small and does not fall any more (round-off).
inline bool settled(double residual, double before, double tolerance) {
  return residual <= tolerance || (residual <= 1e-9 && residual > 0.5 * before);
}

}  // namespace uplift
