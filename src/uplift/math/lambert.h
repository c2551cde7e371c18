#pragma once
#include <algorithm>
#include <cmath>

#include "uplift/math/exponential.h"

// The branch of the Lambert W function that softening laws need.
namespace uplift {

/// w = -W0(-z), the root in [0, 1] of w exp(-w) = z, for z in [0, 1/e] (a z above 1/e by rounding counts as 1/e). Full double precision:
/// the root belongs to an argument within a few ulp of z; near z = 1/e the root itself is as ill-conditioned as the vertex of a parabola.
/// No branch and no call, so that loops over it become vector code. Start: interpolation in the branch-point variable p = sqrt(2 (1 - e
/// z)), |w| good to 1e-6, or the power series for small z; then two Halley steps, each of which cubes the error. Source: Corless, Gonnet,
/// Hare, Jeffrey & Knuth, On the Lambert W function, Adv. Comput. Math. 5 (1996), sections 4 and 5.
inline double lambert_root(double z) {
  constexpr double e_high = 0x1.5bf0a8b145769p1, e_low = 0x1.4d57ee2b1013ap-53;
  const double p = std::sqrt(2 * std::max(0.0, (1 - e_high * z) - e_low * z));
  double q = 1.5372880804169972e-3;  // Chebyshev interpolation of (1 - w)/p on [0, 1.415], degree 6
  q = q * p - 1.030928336084335e-2;
  q = q * p + 3.313766241319758e-2;
  q = q * p - 7.481866322098457e-2;
  q = q * p + 1.517385573389499e-1;
  q = q * p - 3.332453790792206e-1;
  q = q * p + 0.9999987410640803;
  double w = z < 1e-3 ? z * (1 + z * (1 + 1.5 * z)) : 1 - p * q;
  for (int step = 0; step < 2; ++step) {
    const double decay = exponential(-w).value, miss = z - w * decay, rest = 1 - w;
    w += 2 * rest * miss / (2 * decay * rest * rest - (2 - w) * miss + 1e-300);
  }
  return w;
}

}  // namespace uplift
