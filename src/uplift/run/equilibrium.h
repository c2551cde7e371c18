#pragma once
#include <memory>
#include <string>
#include <vector>

#include "uplift/elements/space.h"

namespace uplift {

class ForceModel;
struct ForceStage;
class StepBalance;

/// Equilibrium of the whole model at a few instants of a run.
struct Equilibrium {
  /// Force [N] and moment about the middle of the nodes [N m].
  struct Sum {
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  };
  /// Sums over the model. They act on the structure, so that together they are zero: inertia -M a, damping -C v with the absorbing
  /// boundaries, springs to the ground and other parts whose internal forces have a resultant, interfaces whose sides lie apart, the second
  /// order of P-Delta, applied forces with gravity, ground acceleration and waves, and what supports, prescribed motions and ties bear.
  struct Instant {
    double time = 0;  // s
    Sum inertia, damping, internal, joint, second_order, applied, reactions, residual;
    double largest_reaction = 0;  // N: on one unknown
  };
  std::vector<Instant> instants;
  double residual = 0;  // largest residual force or moment, over the largest of the other sums and reactions at any of the instants
  double time = 0;      // s: of that instant
  /// What an engineer should know about a residual that is no round-off; empty up to 1e-6.
  std::string warning() const;
};

/// Collects instants during a stage and sums up their forces at its end, element by element: nothing large is made. The instants of large
/// models are summed up at once instead of kept.
class EquilibriumCheck {
 public:
  static constexpr int most_kept = 100'000;  // beyond, the time of one more pass over the elements is little beside a step
  /// `most`: full unknowns of a model whose instants are kept.
  explicit EquilibriumCheck(const ForceStage& stage, int most = most_kept);
  ~EquilibriumCheck();
  void note(const StepBalance& balance);
  /// Adds the instants to those of earlier stages.
  void finish(Equilibrium& equilibrium);

 private:
  struct Snapshot;
  void add_elements();
  void add_forces(const ForceModel& forces, Snapshot& at) const;
  void balance_snapshots();
  void sum_up(const Vector& forces, double sign, Equilibrium::Sum& sum, Index first = 0) const;

  std::unique_ptr<const ForceStage> stage_;
  const bool at_once_;
  Vec3 centre_ = Vec3::Zero();
  std::vector<Snapshot> snapshots_;
  std::vector<Equilibrium::Instant> instants_;  // of this stage, summed up
};

}  // namespace uplift
