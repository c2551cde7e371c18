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

/// Natural frequencies [Hz] of a case that its time step has to resolve.
struct ResolvedFrequencies {
  std::vector<double> bonded;     // with the interfaces closed, the lowest, and those of `moving`
  std::vector<double> base_free;  // with the interfaces open, the lowest: how the structure vibrates while it rocks or flies
  std::vector<double> moving;     // those of small models, however high, that move part of the mass
};

/// What limits the time step of a case with a dynamic stage, the smallest first; empty when nothing does. The numbers of steps follow from
/// random structures (docs/guide/choosing_the_joint_and_the_step.md).
std::vector<StepBound> step_bounds(const Case& read, const BuiltCase& built, const ResolvedFrequencies& frequencies);

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
