#pragma once
#include <memory>
#include <span>

#include "uplift/base/catalog.h"
#include "uplift/contact/problem.h"

namespace uplift {

/// Enforces the interface laws and cones of one step.
class ContactMethod {
 public:
  virtual ~ContactMethod() = default;
  /// Never throws for numerical reasons: failure is in the outcome.
  virtual Outcome solve(const InterfaceProblem&, InterfaceSolution&) const = 0;
  /// True when contact is enforced exactly (multipliers): the step then takes end-of-step forces and an impact rule.
  virtual bool constrains() const = 0;
  /// A method that regularises constraints puts a traction law in the place of a cone (penalty); null when it does not. `flexibility` is
  /// the largest area * F_ii of the interface's normal rows [m3/N], which scales an automatic stiffness.
  virtual std::unique_ptr<const InterfaceLaw> substitute(const Cone&, double flexibility) const;
};

/// Nothing touches: for models without an interface and for what is computed before a method is chosen.
class NoContact final : public ContactMethod {
 public:
  Outcome solve(const InterfaceProblem&, InterfaceSolution&) const override { return {}; }
  bool constrains() const override { return false; }
};

/// Largest area * F_ii [m3/N] over the normal rows of a block: the displacement of a point under a unit pressure on its own area.
double flexibility(const InterfaceProblem&, const Block&);

std::span<const Entry<ContactMethod>* const> method_catalog();  // "newton", "penalty", "augmented_lagrangian", "lagrange"
std::span<const PartInfo* const> contact_methods();

}  // namespace uplift
