#include <algorithm>
#include <memory>

#include "uplift/contact/method.h"
#include "uplift/contact/newton/newton.h"

// Penalty: the constraint is replaced by a stiff tensionless spring, p = P(stiffness * opening), so that everything else (path average,
// energy ledger, Newton) is that of a traction law. The stiffness is given [Pa/m], or scaled so that (stiffness * area) * F_ii = factor at
// the most flexible point.
namespace uplift {

namespace {

Raw raw_number(double value) {
  return Raw{value, {}, {}};
}
Raw raw_text(std::string value) {
  return Raw{std::move(value), {}, {}};
}

/// The tensionless springs of the law catalog with this stiffness and the cone's friction.
std::unique_ptr<const InterfaceLaw> tensionless(double stiffness, double friction) {
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("type", raw_text("springs"));
  table->entries.emplace_back("K_n", raw_number(stiffness));
  if (friction > 0) {
    table->entries.emplace_back("tangential", raw_text("coulomb"));
    table->entries.emplace_back("K_t", raw_number(stiffness));
    table->entries.emplace_back("friction", raw_number(friction));
  }
  const Values values = check_part(Raw{table, {}, "penalty"}, interface_behaviours());
  return make_part(law_catalog(), values);
}

class PenaltyMethod final : public ContactMethod {
 public:
  PenaltyMethod(double stiffness, double factor, NewtonOptions options) : stiffness_(stiffness), factor_(factor), options_(options) {}

  std::unique_ptr<const InterfaceLaw> substitute(const Cone& cone, double flexibility) const override {
    return tensionless(stiffness_ > 0 ? stiffness_ : factor_ / std::max(flexibility, 1e-300), cone.friction());
  }

  std::unique_ptr<MethodWork> make_work() const override { return std::make_unique<NewtonWork>(); }

  /// A stored problem may still hold cones: they are replaced here, with the stiffness and the memory that were stored with them, or
  /// afresh. In a run they were replaced before the first step. A stiffness of the method's own goes before the stored one.
  Outcome solve(const InterfaceProblem& problem, MethodWork& kept, InterfaceSolution& solution) const override {
    NewtonWork& work = static_cast<NewtonWork&>(kept);
    if (std::ranges::none_of(problem.model->blocks, [](const Block& block) { return block.cone != nullptr; }))
      return solve_by_newton(problem, {}, options_, work, solution);
    InterfaceProblem replaced = problem;
    auto model = std::make_shared<ContactModel>(*problem.model);
    replaced.model = model;
    replaced.free_opening_increment.resize(0);  // its arrays do not stay where they are from step to step
    std::vector<std::unique_ptr<const InterfaceLaw>> laws;
    for (Block& block : model->blocks) {
      if (block.cone == nullptr) continue;
      const bool stored = block.substitute_stiffness > 0 && !(stiffness_ > 0);
      laws.push_back(stored ? tensionless(block.substitute_stiffness, block.cone->friction())
                            : substitute(*block.cone, flexibility(*model, block)));
      block.law = laws.back().get();
      block.cone = nullptr;
      block.first_history = static_cast<int>(replaced.old.size());
      const Index values = block.law->num_history(block.batch.components) * block.batch.points;
      replaced.old.conservativeResizeLike(Vector::Zero(replaced.old.size() + values));
      if (static_cast<Index>(block.substitute_memory.size()) == values)
        std::copy_n(block.substitute_memory.data(), values, replaced.old.data() + block.first_history);
    }
    return solve_by_newton(replaced, {}, options_, work, solution);
  }

  bool constrains() const override { return false; }

 private:
  double stiffness_, factor_;
  NewtonOptions options_;
};

}  // namespace

const Entry<ContactMethod>& entry_method_penalty() {
  static const Entry<ContactMethod> entry{
      {.name = "penalty",
       .summary = "constraints replaced by stiff tensionless springs, stiffness given or scaled from the compliance",
       .equations = "p = P(e g), P the projection on the cone\n"
                    "e = stiffness * area, or e F_ii = factor at the most flexible point of the interface",
       .source = "Cherubini, Richard & Frau, section 2; docs/theory, eq (15)",
       .params = {number("stiffness", "Pa/m", "penalty stiffness per area; absent: scaled by `factor`").positive().optional(),
                  number("factor", "1", "k F_ii of the automatic stiffness").positive().standard(10.0),
                  number("tolerance", "1", "residual of the interface balance, relative to the interface force").positive().standard(1e-12),
                  integer("most_iterations", "iterations before the step is cut").between(1, 10000).standard(60.0)}},
      [](const Values& values) -> std::unique_ptr<const ContactMethod> {
        return std::make_unique<PenaltyMethod>(values.has("stiffness") ? values.number("stiffness") : 0.0, values.number("factor"),
                                               NewtonOptions{values.number("tolerance"), values.integer("most_iterations")});
      }};
  return entry;
}

}  // namespace uplift
