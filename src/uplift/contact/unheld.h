#pragma once
#include <string>

#include "uplift/contact/problem.h"

namespace uplift {

/// Beyond this ratio to the movement with all joints closed a static solution has run away: nothing holds the structure.
inline constexpr double runaway_ratio = 1e3;

/// Which way a structure went in a static step that nothing held, by the interface whose points moved most; empty when none moved by more
/// than `ratio` times what all joints closed would allow. The balance of an interface problem is relative to its own forces, the closed
/// joint that is taken back among them, so that a method may converge there.
std::string unheld_motion(const InterfaceProblem& problem, const InterfaceSolution& solution, double ratio);

/// Where a law softens at the last openings of a static step that has no solution: its point with the steepest descent. Empty where none
/// does. A joint that loses strength faster than the structure unloads it lets go at once, and no equilibrium follows.
std::string softening_joint(const InterfaceProblem& problem, const InterfaceSolution& solution);

}  // namespace uplift
