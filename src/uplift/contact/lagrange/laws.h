#pragma once
#include <vector>

#include "uplift/contact/problem.h"

// Law blocks beside cones: their forces and slopes, for both Lagrange methods.
namespace uplift {

/// Forces of the law blocks at solution.opening, scaled: fills their rows of solution.force and solution.now; `slope` (null: not wanted)
/// gets d force_r / d opening_c of block b, component-major, at [first_slope[b] + (r * components + c) * points + i] [N/m].
void law_forces(const InterfaceProblem&, const std::vector<int>& first_slope, double* slope, InterfaceSolution&);
/// Where the slopes of each block begin, and (last entry) how many there are.
void slope_offsets(const ContactModel&, std::vector<int>& offsets);
/// H += C^T k C of the law blocks. `convex`: of each slope only the positive diagonal, for a Hessian that must be positive definite; the
/// slopes are cut in place. `work` has the size of C.
void add_law_slopes(const ContactModel&, const std::vector<int>& first_slope, Vector& slope, bool convex, Matrix& work, Matrix& hessian);

}  // namespace uplift
