#include "uplift/contact/impact/projection.h"

// v_c = v + v''      [K + 4M/dt^2, C^T; C, 0] [v''; mu] = [0; f C (v' - v)]      C the active rows, v' the projection of eq 4, C v' = 0
// As printed f = 2, which is a reflection, C v_c = -C v, spread by the dynamic stiffness. With A = K + 4M/dt^2 and A^-1 B^T = X C^T (rows C
// of the spread, not of the paper) v'' = X y, where y is the shortest vector with C_A y = -f B_A v. M v'' = (dt^2/4)(B^T mu - K v''), and
// K v'' is balanced inside the structure: the impulse of the contact is (dt^2/4) mu, which keeps the momentum balance.
namespace uplift {
namespace {

class Propagate final : public ImpactRule {
 public:
  explicit Propagate(double factor) : factor_(factor) {}
  bool needs_dynamic() const override { return true; }
  bool force_includes_impulse() const override { return true; }

  void apply(const Impact& impact, Vector& velocity, Vector& impulse, ImpactScratch& scratch) const override {
    if (!select_rows(impact, Hold::equality, scratch)) return;
    project_rate(impact, velocity, nullptr, 0, Select::all, scratch);  // leaves B v in the target
    const Matrix& c = impact.dynamic->factor;
    const Index rows = c.rows();
    for (Index i = 0; i < rows; ++i) scratch.target[i] *= scratch.fixed[i] > 0 ? factor_ : 0;
    scratch.y.resize(c.cols());
    const Rows view{rows, c.cols(), rows, c.data(), scratch.target.data(), scratch.limit.data(), scratch.fixed.data(), 0, 1e-12};
    if (solve_rows(view, scratch.held.data(), scratch.y.data(), scratch.rate.data(), scratch.impulse.data(), scratch.kernel).solved()) {
      impact.dynamic->add(1, scratch.y, velocity);
      for (Index i = 0; i < rows; ++i) impulse[i] += 0.25 * impact.step * impact.step * scratch.impulse[i];
    }
    scratch.y.resize(impact.mass->factor.cols());
  }

 private:
  double factor_;
};

}  // namespace

const Entry<ImpactRule>& entry_impact_propagate() {
  static const Entry<ImpactRule> entry{
      {.name = "propagate",
       .summary = "the paper's correction: the velocity change of the closed rows spread by the dynamic stiffness",
       .equations = "v_c = v + v''\n"
                    "[K + 4M/dt^2, C^T; C, 0] [v''; mu] = [0; f C (v' - v)],  C v' = 0",
       .source = "Cherubini, Richard & Frau, eqs 4-6",
       .params = {number("factor", "1", "f; 2 as printed: a reflection").positive().standard(2.0)}},
      [](const Values& values) { return std::make_unique<const Propagate>(values.number("factor")); }};
  return entry;
}

}  // namespace uplift
