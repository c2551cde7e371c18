#pragma once
#include <optional>

#include "uplift/math/fixed.h"

// Bearing surfaces of shallow foundations in powers of the vertical force: Crémer, Grange, EN 1998-5 Annex F
// (docs/theory/macro_element.md, eqs M17 to M21).
namespace uplift {

/// (|H|/(V q_H(n)))^p_H + (|M|/(D V q_M(n)))^p_M = 1 with q = size n^low (1 - n)^high, n = N/V.
struct MacroPowerLaw {
  struct Term {
    double size = 0;   // > 0
    double low = 1;    // >= 0
    double high = 1;   // > 0
    double power = 2;  // > 1
    /// Logarithm of what stands for n^low and its derivative by ln n: for n < 0.05 the exponent is at most 0.9 (eq M20).
    double log_low(double log_n) const;
    double low_at(double log_n) const;
    /// q at 0 <= n <= 1, and its largest value.
    double at(double n) const;
    double most() const;
  };
  Term shear, moment;

  /// The share of V that h = |H|/V and m = |M|/(D V) leave (eq M19): the 1 - n at which they touch the surface is 1 less this share.
  /// Without a lower limit: negative where h and m alone are too much. `rate`: by n, h, m. For n > 0, h, m >= 0.
  struct Left {
    double share = 1;
    Vec3 rate = Vec3::Zero();
  };
  Left left(double n, double h, double m) const;
};

/// The surface of EN 1998-5:2004, Annex F, for a strip on the surface of homogeneous ground, with its largest n made 1.
struct En1998Surface {
  MacroPowerLaw law;
  double capacity_share = 1;  // (1 - m F^k)^k': the vertical force that it bears, of N_max
};
enum class En1998Soil { cohesive, cohesionless };
/// `inertia`: dimensionless inertia force of the soil F >= 0; none where it leaves no capacity: from `en_1998_5_largest_inertia` on.
std::optional<En1998Surface> en_1998_5_surface(En1998Soil soil, double inertia);
double en_1998_5_largest_inertia(En1998Soil soil);

}  // namespace uplift
