#include "uplift/laws/joint.h"

// Bonded elastic joint: t = K d in tension and in compression. Nothing opens, nothing is lost.
namespace uplift {
namespace {

class ElasticLaw final : public PointLaw {
 public:
  explicit ElasticLaw(double stiffness) : stiffness_(stiffness) {}
  int num_history() const override { return 0; }
  double stiffness() const override { return stiffness_; }

  Point advance(double, double from, double to, Memory, double*) const override {
    return {.mean = stiffness_ * 0.5 * (from + to), .mean_slope = 0.5 * stiffness_, .end = stiffness_ * to, .end_slope = stiffness_};
  }

  PointEnergy energy_at(double opening, Memory) const override { return {.stored = 0.5 * stiffness_ * opening * opening, .dissipated = 0}; }

 private:
  double stiffness_;  // Pa/m
};

}  // namespace

const Entry<InterfaceLaw>& entry_law_elastic() {
  static const Entry<InterfaceLaw> entry = joint_entry(
      {.name = "elastic",
       .summary = "bonded elastic joint that holds tension: what a linear analysis assumes",
       .equations = "t_n = K_n d_n",
       .source = "Cherubini, Richard & Frau, eq 14 with a constant stiffness",
       .params = {number("K_n", "Pa/m", "normal stiffness").positive()}},
      "bonded",
      [](const Values& values) -> std::unique_ptr<const NormalLaw> { return std::make_unique<ElasticLaw>(values.number("K_n")); });
  return entry;
}

}  // namespace uplift
