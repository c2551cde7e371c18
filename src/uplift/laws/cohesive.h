#pragma once
#include "uplift/laws/normal.h"

// Cohesive laws with damage: K the stiffness [Pa/m], F the strength [Pa], k the memory: the largest opening so far [m], d_0 = F/K.
//     d < 0                     t = K d                    compression stays stiff, broken or not
//     0 <= d <= max(k, d_0)     t = (1 - D) K d            unloading along the secant to the origin, D = 1 - envelope(k)/(K k)
//     beyond                    t = envelope(d), k = d     softening; its area from 0 is the fracture energy
// Secant unloading is damage mechanics: Camanho & Davila, NASA/TM-2002-211737 (2002); the joint closes without residual opening.
// Path average: exact on the linear pieces, the envelope's own area on the softening one.
namespace uplift {

/// All that differs from one cohesive law to the other is its envelope beyond d_0.
class CohesiveLaw : public PointLaw {
 public:
  CohesiveLaw(double stiffness, double strength, double energy)
      : stiffness_(stiffness), strength_(strength), energy_(energy), onset_(strength / stiffness) {}
  int num_history() const final { return 1; }
  double stiffness() const final { return stiffness_; }
  LawScales scales() const final {
    return {.strength = strength_, .opening = energy_ / strength_, .least_stiffness = 0.5 * strength_ * strength_ / energy_};
  }
  Point advance(double step, double from, double to, Memory old, double* now) const final;
  PointEnergy energy_at(double opening, Memory history) const final;

 protected:
  /// Traction and its derivative on the envelope, opening >= onset.
  virtual double traction(double opening) const = 0;
  virtual double slope(double opening) const = 0;
  /// Average of the envelope from a to b [Pa], onset <= a <= b, to round-off also when a = b.
  virtual double average(double a, double b) const = 0;
  /// Energy per area dissipated when the largest opening is `opening` >= onset [J/m2].
  virtual double dissipated(double opening) const = 0;

  double stiffness_, strength_, energy_, onset_;  // Pa/m, Pa, J/m2, m
};

/// Refuses a fracture energy that leaves no room for softening: G_f > F_u^2/(2 K_n). Returns G_f.
double checked_fracture_energy(const Values&);

}  // namespace uplift
