#pragma once
#include <memory>
#include <span>

#include "uplift/base/catalog.h"

namespace uplift {

/// One-step implicit schemes of the Newmark family; the displacement is the unknown, velocity and acceleration are affine in it:
///   a1 = (u1 - u0 - dt v0)/(beta dt^2) - (1/(2 beta) - 1) a0        v1 = v0 + dt ((1 - gamma) a0 + gamma a1)
///   M [(1-am) a1 + am a0] + C [(1-af) v1 + af v0] + K [(1-af) u1 + af u0] + B^T [(1-af) p1 + af p0] = (1-af) f1 + af f0
/// (Chung & Hulbert 1993; HHT-alpha: am = 0, af = -alpha; Newmark: am = af = 0). A scheme is coefficients.
///
/// Filtered energy decay is the midpoint form of the trapezoidal rule with passive filters on the increments of displacement, velocity and
/// joint opening (docs/theory, section 3): `gain` b and `pole` a of the filter. A gain of zero is the trapezoidal rule.
struct Scheme {
  double beta = 0.25, gamma = 0.5, alpha_m = 0, alpha_f = 0;
  double pole = 0, gain = 0;
  bool operator==(const Scheme&) const = default;
  bool filtered() const { return gain > 0; }
  /// The step that the matrix K + 2/h C + 4/h^2 M belongs to, over the time step: 1 + 2 b.
  double stretch() const { return 1 + 2 * gain; }
  /// The trapezoidal rule, filtered or not: the path-averaged traction closes the energy balance exactly with it and only with it.
  bool average_acceleration() const { return beta == 0.25 && gamma == 0.5 && alpha_m == 0 && alpha_f == 0; }
  /// A force p at the end of a step puts -w M^-1 B^T p into the velocity [s].
  double velocity_weight(double step) const { return gamma * step * (1 - alpha_f) / (1 - alpha_m); }
  /// Its share in the change of velocity; that of the force at the beginning is the rest. Half with average acceleration.
  double end_share() const { return gamma * (1 - alpha_f) / (1 - alpha_m); }
};

/// Weights of a step. The right-hand side of the displacement increment is
///   R = f1 + f0 af/w - K u0/w - B^T p0 af/w + M (mass_velocity v0 + mass_acceleration a0) - C (damping_velocity v0 + damping_acceleration
///   a0)
/// with w = 1 - af, and for the path average, in the midpoint form with the filters of the scheme (b: gain, h_e = (1 + 2 b) dt),
///   R = (f0 + f1 - 2 K (u0 - b d_u) + (4/h_e) M (v0 - b d_v))/(1 + 2 b)
struct StepWeights {
  double mass = 0, damping = 0;  // K_eff = K + damping C + mass M [1/s2], [1/s]
  double share = 1;              // 1/(1 + 2 b)
  double mass_velocity = 0, mass_acceleration = 0, damping_velocity = 0, damping_acceleration = 0;  // [1/s], 1, 1, [s]
};
StepWeights weights_of(const Scheme& scheme, double step);

std::span<const Entry<Scheme>* const> scheme_catalog();
std::span<const PartInfo* const> schemes();

}  // namespace uplift
