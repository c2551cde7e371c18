#include "uplift/laws/cohesive.h"
#include "uplift/laws/joint.h"
#include "uplift/laws/path.h"

// Bilinear cohesive law: elastic up to F_u, then linear softening to zero at d_f = 2 G_f/F_u. Rules and source: cohesive.h.
namespace uplift {
namespace {

class BilinearLaw final : public CohesiveLaw {
 public:
  BilinearLaw(double stiffness, double strength, double energy)
      : CohesiveLaw(stiffness, strength, energy), last_(2 * energy / strength), slope_(-strength / (last_ - onset_)) {}

 protected:
  double traction(double opening) const override { return -slope_ * larger(last_ - opening, 0); }
  double slope(double opening) const override { return opening < last_ ? slope_ : 0; }
  double average(double a, double b) const override {
    const Piece piece = Path(a, b).below(last_);
    return -slope_ * piece.share * (last_ - piece.middle);
  }
  double dissipated(double opening) const override { return energy_ * (smaller(opening, last_) - onset_) / (last_ - onset_); }

 private:
  double last_, slope_;  // m, Pa/m
};

}  // namespace

const Entry<InterfaceLaw>& entry_law_bilinear() {
  static const Entry<InterfaceLaw> entry = joint_entry(
      {.name = "bilinear",
       .summary = "cohesive law with linear softening and secant unloading",
       .equations = "t_n = K_n d_n for d_n < 0\n"
                    "envelope: K_n d_n up to F_u, then F_u (d_f - d_n)/(d_f - F_u/K_n), zero beyond d_f = 2 G_f/F_u\n"
                    "unloading along the secant to the origin",
       .source = "Camanho & Davila, NASA/TM-2002-211737 (2002), pure mode I",
       .params = {number("K_n", "Pa/m", "normal stiffness").positive().or_word("soil"), number("F_u", "Pa", "tensile strength").positive(),
                  number("G_f", "J/m2", "fracture energy, the area under the envelope").positive()}},
      "bonded", [](const Values& values) -> std::unique_ptr<const NormalLaw> {
        return std::make_unique<BilinearLaw>(values.number("K_n"), values.number("F_u"), checked_fracture_energy(values));
      });
  return entry;
}

}  // namespace uplift
