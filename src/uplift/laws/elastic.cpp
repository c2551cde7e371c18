#include "uplift/laws/joint.h"

// Bonded elastic joint: t = K d + c r in tension and in compression, r = (to - from)/step. Nothing opens; the dashpot takes c r per metre.
// Memory (c > 0 only): the energy that it took [J/m2].
namespace uplift {
namespace {

class ElasticLaw final : public PointLaw {
 public:
  ElasticLaw(double stiffness, double damping) : stiffness_(stiffness), damping_(damping) {}
  int num_history() const override { return damping_ > 0 ? 1 : 0; }
  double stiffness() const override { return stiffness_; }
  LawScales scales() const override { return {.opens = false}; }

  Point advance(double step, double from, double to, Memory old, double* now) const override {
    const double per_step = step > 0 ? damping_ / step : 0, dashpot = per_step * (to - from);  // c/step [Pa/m], c r [Pa]
    if (damping_ > 0) now[0] = old[0] + dashpot * (to - from);
    return {.mean = stiffness_ * 0.5 * (from + to) + dashpot,
            .mean_slope = 0.5 * stiffness_ + per_step,
            .end = stiffness_ * to + dashpot,
            .end_slope = stiffness_ + per_step};
  }

  PointEnergy energy_at(double opening, Memory history) const override {
    return {.stored = 0.5 * stiffness_ * opening * opening, .dissipated = damping_ > 0 ? history[0] : 0};
  }

 private:
  double stiffness_, damping_;  // Pa/m, Pa s/m
};

}  // namespace

const Entry<InterfaceLaw>& entry_law_elastic() {
  static const Entry<InterfaceLaw> entry =
      joint_entry({.name = "elastic",
                   .summary = "bonded elastic joint that holds tension: what a linear analysis assumes",
                   .equations = "t_n = K_n d_n + c d'_n",
                   .source = "Cherubini, Richard & Frau, eq 14 with a constant stiffness",
                   .params = {number("K_n", "Pa/m", "normal stiffness").positive().or_word("soil"),
                              number("c", "Pa s/m", "normal damping").nonnegative().or_word("soil").standard(0.0)}},
                  "bonded", [](const Values& values) -> std::unique_ptr<const NormalLaw> {
                    return std::make_unique<ElasticLaw>(values.number("K_n"), values.number("c"));
                  });
  return entry;
}

}  // namespace uplift
