#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "uplift/contact/impact/coulomb.h"
#include "uplift/contact/impact/impact.h"
#include "uplift/dynamics/contact_rows.h"
#include "uplift/dynamics/energy.h"
#include "uplift/dynamics/scheme.h"

namespace uplift {

/// What the step after an impact begins with beside the state, for the damping force that acted at once (docs/theory, section 5).
struct Kick {
  double step = 0;      // s: of the step of the impact; 0: there was none
  Vector acceleration;  // free unknowns
  Vector force;         // interface rows [N]
};

/// What impacts use of a step size: matrices that the rule does not need are null.
struct ImpactFactors {
  double step = 0;                        // s
  double mass = 0;                        // of M in K_eff [1/s2]
  const BulkFactor* effective = nullptr;  // of K_eff; null where none is needed
  std::unique_ptr<BulkFactor> factor;     // of the matrix behind one of the following, or that of K_eff where the step has no other
  std::unique_ptr<Spread> dynamic;        // of K + 4M/dt^2, for `propagate`
  std::unique_ptr<Spread> damped;         // of M + w D, for `project_hold` with damping D and the trapezoidal rule
  std::unique_ptr<CoulombRates> coulomb;  // by which impulses with friction spread there
};

/// A step that was solved and that impacts may correct: velocity, acceleration and contact force at its end, and its energies.
struct SolvedStep {
  const ImpactFactors& factors;
  const std::vector<Block>& blocks;
  const State& begin;
  State& end;
  Vector& momentum;  // M v at the end
  Energies& energies;
  double friction;      // J: work of the friction of constraints in the step
  double contact_work;  // J: of their pressures, see ContactImpacts
};

/// Impacts of constraints at the end of a step, with friction where points are open, and what they ask of the step after (docs/theory,
/// section 5).
class ContactImpacts {
 public:
  /// Forces that a state's acceleration balances: f - D v - K u - B^T p.
  using Forces = std::function<void(const State&, Vector&)>;
  ContactImpacts(const ImpactRule& rule, const Scheme& scheme, const Bulk& bulk, ContactRows rows, const std::vector<Block>& blocks,
                 Forces forces, LinearCounts& counts);
  ContactRows& rows() { return rows_; }
  /// What the step to come begins with. Setting it goes on where another march has been.
  Kick kick() const { return kick_.step > 0 ? kick_ : Kick(); }
  void set_kick(const Kick& kick);
  /// Drops what speeds up the next step.
  void forget() { scratch_ = {}; }

  /// The step after an impact takes back what damping did at once, as far as it is as long as the step of the impact.
  void begin_step(State& begin, double step);
  /// Work of what the beginning then lacks in equilibrium, which belongs to the impact [J].
  double lag_work(const Vector& increment) const;
  double contact_work(const std::vector<Block>& blocks, const State& begin, const InterfaceSolution& end) const;
  /// Takes forces out of the beginning of a step that would create energy; `of_pressures`: contact_work of the step, `scale`: of energies
  /// [J]. True when there are any: the step is solved again.
  bool drop_creating(const std::vector<Block>& blocks, State& begin, const InterfaceSolution& end, const Energies& energies,
                     double of_pressures, double scale);
  /// Puts these forces back.
  void restore_dropped(State& begin);
  /// Takes back what begin_step did: a step that has failed leaves its beginning as it was.
  void undo(State& begin);
  /// Corrects the end of the step by the rule of impact. The mean force of the end is that with the impulse where it belongs to the force.
  void apply(SolvedStep& step);
  /// The step was taken.
  void accept();
  /// Momentum that impacts transferred in the step, per interface row [N s], compression < 0; null where no gap has closed.
  const Vector* transferred() const { return closing_ ? &transferred_ : nullptr; }

 private:
  void strike(SolvedStep& step);
  bool gap_closes(const State& begin) const;
  bool apply_rule(SolvedStep& step, Impact& data);
  void soften(const SolvedStep& step, Vector& acceleration);
  bool is_round_off(const Vector& change, const Vector& velocity);
  void damp_impact(const SolvedStep& step, const Vector& velocity, Vector& acceleration);
  void separate_impulse(SolvedStep& step, const Impact& data);
  void read_forces(SolvedStep& step, const Impact& data, bool with_friction);
  void balance_damping(SolvedStep& step, Impact& data, bool with_friction);
  // with friction (impact_friction.cpp)
  bool wants_friction(const SolvedStep& step, const Impact& data);
  bool impact_of_friction(SolvedStep& step, const Impact& data);
  bool obey_friction(SolvedStep& step, const Spread& spread, CoulombRates& law, const Impact& data, const Vector& velocity,
                     Vector& acceleration);
  void take_forces(const SolvedStep& step);

  const ImpactRule& rule_;
  const Scheme scheme_;
  const bool passive_;  // forces of the beginning of a step shall create no energy
  const Bulk& bulk_;
  ContactRows rows_;
  const Forces forces_;
  BulkWork work_;
  ImpactScratch scratch_;
  std::unique_ptr<CoulombRates> coulomb_;  // null without friction, and with other rules than project_hold
  Vector transferred_;                     // rows [N s]: where a gap closes
  Vector correction_;                      // rows [N s]: what the rule added to the impulses that the step contains; empty: not needed
  bool closing_ = false;                   // a gap closes in the step
  Kick kick_, next_kick_;                  // of impacts at the beginning and at the end of the step
  Kick unkicked_;                          // acceleration and force of the beginning without it
  Vector lag_;                             // unknowns [N]: M a of the beginning with it, less the forces
  struct {
    bool any = false, slip = false;  // forces of the beginning have been reduced; points with friction are among them. They were:
    Vector force, acceleration;      // rows, unknowns
  } dropped_;
  Vector free_velocity_;             // of the end before the impact
  Vector change_, load_, response_;  // work space of bulk systems
  struct FrictionScratch {
    Vector taken, rates, takes_part, impulse;  // rows; taken: forces that are taken out
    Vector change;                             // rows: of the impulse over that of the forces [N s]
    Vector velocity, after, soon;              // unknowns: velocity and acceleration after the impact, velocity half a step later
    Vector push;                               // C^T p of the mass
  } friction_;
};

}  // namespace uplift
