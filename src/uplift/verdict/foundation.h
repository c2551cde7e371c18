#pragma once
#include <vector>

#include "uplift/case/case.h"

// What the bases and walls of a foundation carry together.
namespace uplift {

/// Largest horizontal force and overturning moment that all interfaces together exert on the ground, and what each of them carries then.
struct FoundationForces {
  StepRecord::Reached shear, moment;    // N, N m; the moment about the middle of the bases, by area
  double least = 0;                     // N: a horizontal force below this is noise (noise_share of what acts)
  std::vector<double> share_of_shear;   // per interface, at the time of the largest total; they add up to 1
  std::vector<double> share_of_moment;  // likewise
};
FoundationForces foundation_forces(const BuiltCase& built, const RunResult& run);

}  // namespace uplift
