#pragma once
#include <string>
#include <vector>

#include "uplift/case/case.h"

namespace uplift {

/// A time step that something in a case asks for.
struct StepBound {
  double step = 0;  // s
  std::string reason;
};

/// What limits the time step of a case with a dynamic stage, the smallest first; empty when nothing does. `bonded`: its lowest natural
/// frequencies with the interfaces closed [Hz]. The numbers of steps are those at which the forces of the verdict of random structures
/// were found to be within 3 % of those with an eighth of the step, in nine of ten cases (docs/guide).
std::vector<StepBound> step_bounds(const Case& read, const BuiltCase& built, const std::vector<double>& bonded);

/// Loads and motions that are functions of time.
std::vector<const TimeLoad*> varying_loads(const Model& model);
/// Of the dynamic stages together [s].
double dynamic_duration(const RunPlan& plan);

/// By how much straight lines between the values at the steps differ from a function on average over `duration` [s], relative to its mean
/// magnitude; 1 for a pulse between two steps, which they miss.
double unresolved_share(const TimeFunction& function, int derivative, double duration, double step);

/// Largest step of 1, 2 or 5 times a power of ten, `most` or smaller, at which this share is at most 0.01. Never below 1e-5 s.
double step_that_resolves(const TimeFunction& function, int derivative, double duration, double most);

}  // namespace uplift
