#pragma once
#include <span>
#include <vector>

#include "uplift/motion/motion.h"

namespace uplift {

/// Velocity [m/s] and displacement [m] at the points of an acceleration [m/s2] that is straight between them, from rest at t = 0: exact.
struct Integrals {
  std::vector<double> velocity, displacement;
};
Integrals integrals_of(std::span<const double> acceleration, double step);

/// The motion as acceleration, velocity or displacement, at the same times; unchanged when it is that already.
///
/// An acceleration is straight between its points, so that its integrals from rest are exact. A velocity or displacement is a cubic spline
/// through its points (the displacement with no velocity at t = 0); its derivatives are taken. Integrating the acceleration of a
/// displacement gives the displacement back, but for its first value.
Motion converted(Motion motion, MotionKind kind);

/// The slope of that spline through a sine of `cycles` per step, over the slope of the sine, at the points (docs/theory, eq 32a): 1 for
/// slow sines, 0 for half a cycle per step.
double spline_slope_share(double cycles);

}  // namespace uplift
