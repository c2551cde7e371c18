#include "uplift/contact/impact/projection.h"

namespace uplift {
namespace {

class Reflect final : public ImpactRule {
 public:
  bool force_includes_impulse() const override { return true; }
  void apply(const Impact& impact, Vector& velocity, Vector& impulse, ImpactScratch& scratch) const override {
    if (!select_rows(impact, Hold::equality, scratch)) return;
    project_rate(impact, velocity, nullptr, impact.velocity_weight, Select::all, scratch);
    correct(impact, 2, velocity, scratch);
    add_impulse(impact, 2, impulse, scratch);
  }
};

}  // namespace

const Entry<ImpactRule>& entry_impact_reflect() {
  static const Entry<ImpactRule> entry{
      {.name = "reflect",
       .summary = "velocity reflected at the active constraints: keeps the kinetic energy exactly",
       .equations = "v' = 2 v_p - v,  v_p = argmin |v_p - v|_M^2 / 2,  B_A v_p = 0",
       .source = "Cherubini, Richard & Frau, the limit of eqs 5-6 for dt -> 0; docs/theory, eqs (18) and (19)",
       .params = {}},
      [](const Values&) { return std::make_unique<const Reflect>(); }};
  return entry;
}

}  // namespace uplift
