#include "uplift/contact/impact/projection.h"

namespace uplift {
namespace {

class Project final : public ImpactRule {
 public:
  void apply(const Impact& impact, Vector& velocity, Vector& impulse, ImpactScratch& scratch) const override {
    if (!select_rows(impact, Hold::inequality, scratch)) return;
    project_rate(impact, velocity, impact.moved_velocity, impact.velocity_weight, Select::all, scratch);
    correct(impact, 1, velocity, scratch);
    add_impulse(impact, 1, impulse, scratch);
  }
};

}  // namespace

const Entry<ImpactRule>& entry_impact_project() {
  static const Entry<ImpactRule> entry{
      {.name = "project",
       .summary = "velocity projected on the constraints in the metric of M, as an inequality. Alone it creates energy: an undamped "
                  "mass, spring and stop gained 162 % of its energy, with other steps many times its energy; "
                  "project_hold creates none",
       .equations = "w = v + gamma dt M^-1 B_A^T p\n"
                    "v' = argmin |v' - w|_M^2 / 2,  B_A v' >= 0, impulses compressive",
       .source = "Cherubini, Richard & Frau, eq 4; Moreau (1988) for the inequality",
       .params = {}},
      [](const Values&) { return std::make_unique<const Project>(); }};
  return entry;
}

}  // namespace uplift
