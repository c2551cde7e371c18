#pragma once
#include <string>

#include "uplift/contact/newton/newton.h"

// What the residual G of Newton's method (newton.h) is judged by, where the forces and slopes at solution.z and G have been found.
namespace uplift {

/// What G is measured against: the largest of |z| and |C^T p| [sqrt(J)]. In dynamics C^T p = G - z; in statics the closed joint is taken
/// back in G, and `work.direction` is overwritten.
double balance_scale(const InterfaceProblem&, NewtonWork&, const InterfaceSolution&);
/// Size of G that round-off in the openings alone makes [sqrt(J)]: stiff joints magnify it.
double balance_round_off(const InterfaceProblem&, NewtonWork&, const InterfaceSolution&);
/// Why forces are not finite.
std::string why_not_finite(const InterfaceProblem&, const InterfaceSolution&);

}  // namespace uplift
