#pragma once
#include <memory>
#include <span>
#include <vector>

#include "uplift/base/catalog.h"
#include "uplift/contact/compliance.h"
#include "uplift/contact/kernel/kernel.h"
#include "uplift/contact/problem.h"

namespace uplift {

/// What an impact rule may know of the step just solved. Rows are interface rows; compression is negative.
struct Impact {
  const Spread* mass = nullptr;     // of M; all that the rows touch has mass (check_dynamic)
  const Spread* dynamic = nullptr;  // of K + 4M/dt^2 (eq 5); only for rules that ask for it
  const Matrix* b = nullptr;        // dense B, rows x free (null when large), or
  const Sparse* sparse_b = nullptr;
  // all rows: weight of the active normal rows (compressed), 0 elsewhere: the area of the row's point [m2], by which redundant impulses are
  // shared, or all alike
  const Vector* pressed = nullptr;
  std::span<const int> tangents;  // sticking tangential rows: equalities
  const Vector* force = nullptr;  // all rows: contact force at the end of the step [N], tension > 0
  const Vector* area = nullptr;   // all rows: the same weight, for the tangents; null: all alike
  double velocity_weight = 0;     // gamma * dt [s]: a force p at the end of the step put -velocity_weight * M^-1 B^T p into the velocity
  double step = 0;                // s: of the step just solved
  // all rows: what prescribed motions alone make of the openings' rates at the end of the step [m/s, m/s2]; null: nothing, and always for
  // rules whose force includes the impulse, which are refused there
  const Vector* moved_velocity = nullptr;
  const Vector* moved_acceleration = nullptr;
  double acceleration_weight = 1;  // and -acceleration_weight * M^-1 B^T p into the acceleration
};

/// Work space of a rule, sized at the first call and kept between steps.
struct ImpactScratch {
  KernelScratch kernel;
  Vector target, limit, fixed, held;  // rows: rate of the opening without the contact force, weights of the rows (kernel.h)
  Vector rate, taken, impulse;        // rows: that rate corrected, force that was taken out, total impulse
  Vector total;                       // rows: total impulse of the velocity, where the acceleration is projected too
  Vector y, push;                     // r
  Index first = 0, count = 0;         // range of rows that holds the active ones
  bool any_fixed = false;             // some rows are held both ways
};

class ImpactRule {
 public:
  virtual ~ImpactRule() = default;
  virtual bool acts() const { return true; }
  virtual bool needs_dynamic() const { return false; }
  /// True when the force of the displacement solve alone is not the contact force: the correction's impulse / dt is added to it (reflect,
  /// propagate).
  virtual bool force_includes_impulse() const { return false; }
  /// True when `hold` corrects the acceleration.
  virtual bool holds_acceleration() const { return false; }
  /// Corrects the velocity of the free unknowns in place. To `impulse` (rows, N s, compression negative) it adds what the correction put
  /// in; empty: that is not asked for.
  virtual void apply(const Impact&, Vector& velocity, Vector& impulse, ImpactScratch&) const = 0;
  /// After `apply`: corrects the acceleration, which must balance the forces at the corrected velocity. The scratch then holds the force
  /// that belongs to it, and the impulse of the velocity.
  virtual void hold(const Impact&, Vector& /*acceleration*/, ImpactScratch&) const {}
};

/// The integrator's velocity is kept: the rule "none"; also for models without an interface.
class NoImpact final : public ImpactRule {
 public:
  bool acts() const override { return false; }
  void apply(const Impact&, Vector&, Vector&, ImpactScratch&) const override {}
};

std::span<const Entry<ImpactRule>* const> impact_catalog();  // none, project, project_hold, reflect, propagate
std::span<const PartInfo* const> impact_rules();

}  // namespace uplift
