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

/// A natural mode that the time step has to resolve.
struct ResolvedMode {
  double frequency = 0;  // Hz
  double damping = 0;    // ratio to the critical one, of what damps outside the joints
};

/// Those of a case.
struct ResolvedModes {
  std::vector<ResolvedMode> bonded;     // with the interfaces closed, the lowest, and `moving`
  std::vector<ResolvedMode> base_free;  // with the interfaces open, the lowest elastic ones: while the structure rocks or flies
  std::vector<ResolvedMode> moving;     // bonded ones of small models, however high, that move part of the mass
  // The lowest bonded one that moves part of the mass, with the least damping of those that sway most along an axis; 0 Hz: there is none
  ResolvedMode lowest;
};

/// By how many times more steps a period takes a mode of a structure with little damping than one with 2 %, from 1 to 4. The trapezoidal
/// rule delays free vibration by the phase w t (w h)^2/12. With damping the difference is largest at t = 1/(zeta w), 1/e of (w h)^2/(12
/// zeta) of the amplitude; without, it grows until the next impact, which comes within a period of the lowest mode, and is handed on there.
/// Number of steps ~ its root; less than a twentieth more is none. What the lowest modes forget, which carry the structure from impact to
/// impact, the others do not remember.
double steps_for_memory(const ResolvedMode& mode, const ResolvedMode& lowest);

/// What limits the time step of a case with a dynamic stage, the smallest first; empty when nothing does. The numbers of steps follow from
/// random structures (docs/guide/choosing_the_joint_and_the_step.md).
std::vector<StepBound> step_bounds(const Case& read, const BuiltCase& built, const ResolvedModes& modes);

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
