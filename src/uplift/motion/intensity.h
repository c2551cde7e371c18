#pragma once
#include <vector>

#include "uplift/motion/motion.h"

namespace uplift {

/// Standard gravity [m/s2], in the definition of the Arias intensity.
inline constexpr double standard_gravity = 9.80665;

/// What one number can say of a motion. From an acceleration that is straight between its points: all integrals are exact.
struct Intensity {
  double pga = 0, pgv = 0, pgd = 0;  // m/s2, m/s, m: largest magnitudes; velocity and displacement from rest, peaks between points included
  double arias = 0;                  // m/s: pi/(2 g) integral of a2
  double cav = 0;                    // m/s: integral of |a|
  double d5 = 0, d95 = 0;            // s: times at which 5 % and 95 % of the Arias intensity have come in
  double housner = 0;                // m: integral of the pseudo-velocity spectrum, 5 % damping, over periods from 0.1 s to 2.5 s
  double significant_duration() const { return d95 - d5; }  // s
};

/// All of them; the motion is an acceleration (assertion). A motion that is zero throughout has zeros.
Intensity intensity_of(const Motion& acceleration);

/// Arias intensity that has come in up to every point [m/s].
std::vector<double> husid(const Motion& acceleration);
/// Time at which `share` (0 to 1) of the Arias intensity has come in [s], within the step exactly; 0 for a motion that is zero throughout.
double arias_time(const Motion& acceleration, double share);

}  // namespace uplift
