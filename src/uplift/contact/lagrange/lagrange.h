#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "uplift/contact/kernel/kernel.h"
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

/// Forces of the law blocks at solution.opening, scaled: fills their rows of solution.force and solution.now; `slope` (null: not wanted)
/// gets d force_r / d opening_c of block b, component-major, at [first_slope[b] + (r * components + c) * points + i] [N/m].
void law_forces(const InterfaceProblem&, const std::vector<int>& first_slope, double* slope, InterfaceSolution&);
/// Where the slopes of each block begin, and (last entry) how many there are.
void slope_offsets(const ContactModel&, std::vector<int>& offsets);
/// H += C^T k C of the law blocks. `convex`: of each slope only the positive diagonal, for a Hessian that must be positive definite; the
/// slopes are cut in place. `work` has the size of C.
void add_law_slopes(const ContactModel&, const std::vector<int>& first_slope, Vector& slope, bool convex, Matrix& work, Matrix& hessian);
/// H += C_left^T diag(weight) C_right for as many rows as there are weights, from rows `left` and `right` on.
void add_weighted_gram(const ContactModel&, Index left, Index right, const ConstMap& weight, Matrix& work, Matrix& hessian);
/// When the iterations may stop: below the tolerance, or where the residual is small and does not fall any more (round-off).
bool settled(double residual, double before, double tolerance);

/// Why the kernel failed, with the point named; `first` is the problem's row of the kernel's row 0.
std::string kernel_failure(const ContactModel&, const KernelReply&, std::ptrdiff_t first);
/// "point 3 of 'footing'" for a row.
std::string point_name(const ContactModel&, std::ptrdiff_t row);
/// "points 3, 7 of 'footing'; point 1 of 'key'", at most `most` of them.
std::string point_names(const ContactModel&, const std::vector<std::ptrdiff_t>& rows, std::size_t most = 8);
/// Sizes opening, force, status, now, and z for the problem.
void size_solution(const InterfaceProblem&, InterfaceSolution&);

}  // namespace uplift
