#pragma once
#include <memory>
#include <span>

#include "uplift/base/catalog.h"
#include "uplift/contact/problem.h"

namespace uplift {

/// Work space of a method, kept from step to step so that nothing is allocated after the first one. It fits any model: what was computed
/// from one is dropped when another comes (SeenModel). It serves one thread at a time.
struct MethodWork {
  MethodWork() = default;
  MethodWork(const MethodWork&) = delete;
  MethodWork& operator=(const MethodWork&) = delete;
  virtual ~MethodWork() = default;
};

/// Enforces the interface laws and cones of one step. Constant and shared; what changes is in its work space.
class ContactMethod {
 public:
  virtual ~ContactMethod() = default;
  /// Work space of this method's own type, which `solve` is called with.
  virtual std::unique_ptr<MethodWork> make_work() const = 0;
  /// Starts from the `z` and `status` in the solution and fills its results: z, opening, force and now; with the path average end_traction
  /// and next_slope, with a joint filter plain; status under cones. Never throws for numerical reasons: failure is in the outcome.
  virtual Outcome solve(const InterfaceProblem&, MethodWork&, InterfaceSolution&) const = 0;
  /// One problem alone.
  Outcome solve(const InterfaceProblem& problem, InterfaceSolution& solution) const { return solve(problem, *make_work(), solution); }
  /// True when contact is enforced exactly (multipliers): the step then takes end-of-step forces and an impact rule.
  virtual bool constrains() const = 0;
  /// A method that regularises constraints puts a traction law in the place of a cone (penalty); null when it does not. `flexibility` is
  /// the largest area * F_ii of the interface's normal rows [m3/N], which scales an automatic stiffness.
  virtual std::unique_ptr<const InterfaceLaw> substitute(const Cone&, double /*flexibility*/) const { return nullptr; }
};

/// Nothing touches: for models without an interface and for what is computed before a method is chosen.
class NoContact final : public ContactMethod {
 public:
  std::unique_ptr<MethodWork> make_work() const override { return std::make_unique<MethodWork>(); }
  Outcome solve(const InterfaceProblem&, MethodWork&, InterfaceSolution&) const override { return {}; }
  bool constrains() const override { return false; }
};

std::span<const Entry<ContactMethod>* const> method_catalog();  // "newton", "penalty", "augmented_lagrangian", "lagrange"
std::span<const PartInfo* const> contact_methods();
/// The method of a case that names none: multipliers where there are constraints, Newton's method for traction laws alone.
std::string_view standard_method(bool constraints);
/// Another method of the catalog that enforces constraints exactly.
std::string_view other_exact_method(std::string_view method);

}  // namespace uplift
