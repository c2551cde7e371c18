#include "uplift/contact/impact/projection.h"

namespace uplift {
namespace {

class ProjectHold final : public ImpactRule {
 public:
  bool holds_acceleration() const override { return true; }
  void apply(const Impact& impact, Vector& velocity, Vector& impulse, ImpactScratch& scratch) const override {
    if (!select_rows(impact, Hold::inequality, scratch)) return;
    project_rate(impact, velocity, impact.moved_velocity, impact.velocity_weight, Select::all, scratch);
    correct(impact, 1, velocity, scratch);
    add_impulse(impact, 1, impulse, scratch);
    scratch.total.swap(scratch.impulse);
  }
  void hold(const Impact& impact, Vector& acceleration, ImpactScratch& scratch) const override {
    if (scratch.count == 0) return;
    project_rate(impact, acceleration, impact.moved_acceleration, impact.acceleration_weight, Select::held, scratch);
    correct(impact, 1, acceleration, scratch);
  }
};

}  // namespace

const Entry<ImpactRule>& entry_impact_project_hold() {
  static const Entry<ImpactRule> entry{
      {.name = "project_hold",
       .summary =
           "velocity projected as in `project`, and the acceleration of the rows that stay closed too; with friction, where points open or "
           "close, the impulses of Coulomb's law",
       .equations = "v' as in `project`, in the metric of M + gamma dt D, D the damping\n"
                    "a' = argmin |a' - (a + M^-1 B_A^T p)|_M^2 / 2,  B a' >= 0 on the rows with B v' = 0\n"
                    "where a gap closes: in the metric of M + gamma dt D, from (M + gamma dt D)^-1 M a",
       .source = "Cherubini, Richard & Frau, eq 4, completed for the acceleration (docs/theory, eqs (18), (18a) and (18b))",
       .params = {}},
      [](const Values&) { return std::make_unique<const ProjectHold>(); }};
  return entry;
}

}  // namespace uplift
