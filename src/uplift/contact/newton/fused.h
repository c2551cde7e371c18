#pragma once
#include "uplift/contact/newton/newton.h"

// Newton's method for one interface that only opens and closes, under a rigid footing (up to three coordinates), path-averaged: the law
// makes each iteration in one pass over the points (laws/fused.h), and the first guess needs none. This is the whole of a step of a small
// model, so that it counts every pass; where it does not get through at once, the general method goes on.
namespace uplift {

/// Whether it suits the problem; if so, the solution is sized and the pass laid out. Condensed problems keep their arrays from step to
/// step.
bool may_sweep(const InterfaceProblem&, NewtonWork&, InterfaceSolution&);

/// For problems that may_sweep. False when the law does not offer a pass for these paths or when the residual does not fall by half:
/// solution.z is then the best guess so far, and `outcome` counts the iterations.
bool solve_by_sweeps(const InterfaceProblem&, const NewtonOptions&, NewtonWork&, InterfaceSolution&, Outcome&);

}  // namespace uplift
