#pragma once
#include <vector>

#include "uplift/math/linalg.h"

namespace uplift {

/// What an acceleration shall do to oscillators of one damping: the largest response to each.
struct SpectralDemand {
  double step = 0;  // s, of the acceleration
  double damping = 0;
  std::vector<double> frequencies, target;  // Hz; pseudo-accelerations [m/s2]
  std::size_t limits = 0;                   // of the first so many frequencies the target must not be exceeded, nothing more
  double peak = 0;                          // m/s2: the largest value of the acceleration itself; 0: not asked for
};

/// The change of an acceleration that would bring the largest responses to their targets if they stayed at their times, and its integrals
/// to rest at zero displacement at the end: of all such changes the smallest in the norm of (change/envelope). With one row h_i of H for
/// each response r_i = h_i a at its time, and E = diag(envelope):
///
///   change = share E E H^T z,     (H E E H^T + small diagonal) z = sign(r) target - r
///
/// The rows of the oscillators are their impulse responses backwards in time, as in Lilhanand and Tseng (1988); the common solution for all
/// frequencies, the weight and the end conditions take the place of their single wavelets with baseline corrections.
Vector spectral_change(const Vector& acceleration, const Vector& envelope, const SpectralDemand& demand, double share);

/// The smallest change, in the same norm, after which velocity and displacement (from rest, acceleration straight between its points) are
/// zero at the end.
Vector rest_change(const Vector& acceleration, const Vector& envelope, double step);

}  // namespace uplift
