#include <cmath>

#include "uplift/laws/cohesive.h"
#include "uplift/laws/joint.h"

// Exponential cohesive law: elastic up to F_u at d_0 = F_u/K_n, then t = F_u exp(-b (d - d_0)) with b = F_u/(G_f - F_u^2/(2 K_n)), so that
// the whole area is G_f. Rules and source of the unloading: cohesive.h; the exponential: Oliver, Cervera, Oller & Lubliner, Isotropic
// damage models and smeared crack analysis of concrete (1990).
namespace uplift {
namespace {

class ExponentialLaw final : public CohesiveLaw {
 public:
  ExponentialLaw(double stiffness, double strength, double energy)
      : CohesiveLaw(stiffness, strength, energy), rate_(strength / (energy - 0.5 * strength * strength / stiffness)) {}

 protected:
  double traction(double opening) const override { return strength_ * std::exp(-rate_ * (opening - onset_)); }
  double slope(double opening) const override { return -rate_ * traction(opening); }
  double average(double a, double b) const override {
    const double x = rate_ * (b - a);
    return x > 0 ? traction(a) * -std::expm1(-x) / x : traction(a);
  }
  /// Work up to `opening` along the envelope less the energy of the secant, written without differences of large numbers.
  double dissipated(double opening) const override {
    const double x = rate_ * (opening - onset_);
    return strength_ * ((0.5 * onset_ + 1 / rate_) * -std::expm1(-x) - 0.5 * (opening - onset_) * std::exp(-x));
  }

 private:
  double rate_;  // 1/m
};

}  // namespace

const Entry<InterfaceLaw>& entry_law_exponential() {
  static const Entry<InterfaceLaw> entry = joint_entry(
      {.name = "exponential",
       .summary = "cohesive law with exponential softening and secant unloading",
       .equations = "t_n = K_n d_n for d_n < 0\n"
                    "envelope: K_n d_n up to F_u, then F_u exp(-b (d_n - F_u/K_n)), b = F_u/(G_f - F_u^2/(2 K_n))\n"
                    "unloading along the secant to the origin",
       .source = "Oliver, Cervera, Oller & Lubliner (1990); secant unloading: Camanho & Davila, NASA/TM-2002-211737 (2002)",
       .params = {number("K_n", "Pa/m", "normal stiffness").positive().or_word("soil"), number("F_u", "Pa", "tensile strength").positive(),
                  number("G_f", "J/m2", "fracture energy, the area under the envelope").positive()}},
      "bonded", [](const Values& values) -> std::unique_ptr<const NormalLaw> {
        return std::make_unique<ExponentialLaw>(values.number("K_n"), values.number("F_u"), checked_fracture_energy(values));
      });
  return entry;
}

}  // namespace uplift
