#include "uplift/contact/method.h"

#include <fmt/format.h>

#include "uplift/contact/newton/newton.h"

namespace uplift {
namespace {

class NewtonMethod final : public ContactMethod {
 public:
  explicit NewtonMethod(NewtonOptions options) : options_(options) {}
  std::unique_ptr<MethodWork> make_work() const override { return std::make_unique<NewtonWork>(); }
  Outcome solve(const InterfaceProblem& problem, MethodWork& work, InterfaceSolution& solution) const override {
    for (const Block& block : problem.model->blocks)
      if (block.law == nullptr) {
        Outcome outcome;
        outcome.why = fmt::format("method \"newton\" needs a traction law, interface \"{}\" has a constraint", block.name);
        return outcome;
      }
    return solve_by_newton(problem, {}, options_, static_cast<NewtonWork&>(work), solution);
  }
  bool constrains() const override { return false; }

 private:
  NewtonOptions options_;
};

}  // namespace

const Entry<ContactMethod>& entry_method_newton() {
  static const Entry<ContactMethod> entry{
      {.name = "newton",
       .summary = "Newton's method with line search on traction laws (SDM, springs, cohesive, elastic)",
       .equations = "G(z) = z + C^T p(opening) = 0, opening = free opening + C z\n"
                    "H = I + C^T (dp/d opening) C, symmetric positive definite when the law does not soften\n"
                    "line search on the directional derivative of the incremental potential",
       .source = "docs/theory, section 4",
       .params = {number("tolerance", "1", "residual of the interface balance, relative to the interface force").positive().standard(1e-12),
                  integer("most_iterations", "iterations before the step is cut").between(1, 10000).standard(60.0)}},
      [](const Values& values) -> std::unique_ptr<const ContactMethod> {
        return std::make_unique<NewtonMethod>(NewtonOptions{values.number("tolerance"), values.integer("most_iterations")});
      }};
  return entry;
}

}  // namespace uplift
