#pragma once
#include <memory>
#include <string>
#include <vector>

#include "uplift/dynamics/joint_filter.h"
#include "uplift/dynamics/step_balance.h"
#include "uplift/dynamics/step_sizes.h"

namespace uplift {

struct StepCounts {
  long steps = 0, retries = 0, iterations = 0, cycles = 0;
  int deepest = 0;  // largest number of halvings that was needed
};

/// What a stage hands on to the next one beside its state.
struct StageHandover {
  Energies energies;
  double initial_energy = 0, largest_external = 0;  // J
  bool acceleration = false;                        // the state's acceleration is that of the scheme and goes on
  Kick kick;                                        // of an impact in the last step
};

/// Where the march through a stage stands between two steps: a value, from which another Stepper of the same stage goes on.
struct MarchState {
  State state;
  StageHandover handover;
  StepCounts counts;
  double start_time = 0;   // s: of the stage
  double origin = 0;       // J: what the balance is measured from
  std::vector<int> sizes;  // halvings whose matrices have been factorised
};

/// Marches a state in time.
class Stepper {
 public:
  Stepper(const StageModel& stage, const ContactChoice& contact, const ImpactRule& impact, const LinearSolver& solver,
          const StepOptions& options, LinearCounts& counts);
  Stepper(const Stepper&) = delete;  // its parts refer to it
  Stepper& operator=(const Stepper&) = delete;
  /// Takes over displacement, velocity, opening and history; the initial acceleration follows from the balance (the path average
  /// needs none: that of its state is empty). With the handover of a stage before, energies go on counting, and so does its acceleration
  /// when it is the same scheme's.
  void start(State state, const StageHandover* before = nullptr);
  StageHandover handover() const {
    return {energies_, initial_energy_, largest_external_, !path_, impacts_ != nullptr ? impacts_->kick() : Kick()};
  }
  /// Goes on where another Stepper of the same stage has been: takes the place of `start`. After `reenter` of that one both take the same
  /// steps to the last bit.
  void resume(MarchState from);
  /// The state with what the filters of the interfaces remember, which that of `state` lacks: for another Stepper.
  State whole_state() const;
  /// Where the march stands; called between two steps.
  MarchState march_state() const;
  /// Drops first guesses and makes everything anew that follows from the state: the next step depends on the march state alone.
  void reenter();
  /// One step of the nominal size. A part that fails is halved and tried again; false when the smallest part fails too: the state stays
  /// that of the last success and `why`, `failed` tell.
  bool advance();
  const State& state() const { return now_; }
  const Energies& energies() const { return energies_; }
  const StepCounts& counts() const { return counts_; }
  const std::string& why() const { return why_; }
  /// The interface problem of the last try.
  const InterfaceProblem* problem() const { return last_; }
  /// Acceleration [m/s2]: with the path average at an interface the mean over the step, (v1 - v0)/dt, which converges with the step where a
  /// stiff joint makes that at its end alternate; else that at the end of the step (and before the first one), from the balance or the
  /// scheme.
  void acceleration(Vector& result) const;
  bool averages_acceleration() const { return path_ && stage_.b.rows() > 0; }
  /// The motion and forces that the last step balanced; valid until the next step. `start` is the acceleration before the first step.
  StepBalance balance(const Vector& start) const;
  /// Length of the last step that failed [s].
  double failed_step() const { return failed_step_; }
  /// Largest external work met [J], for the scale of the energy error.
  double largest_external() const { return largest_external_; }
  double initial_energy() const { return initial_energy_; }
  /// Impacts of constraints; null where there are none.
  const ContactImpacts* impacts() const { return impacts_.get(); }

 private:
  bool try_step(StepSize& size);
  bool balance_step(StepSize& size);
  bool substep(int halving);
  /// Its factor of M is large: made when it is first asked for.
  const Accelerator& accelerator() const;
  void make_room();
  void begin_acceleration();
  void follow_state();
  void force_at(double time, Vector& force) const;
  /// ku = K u and mv = M v, in one pass where the bulk is large.
  void products(const Vector& u, const Vector& v, Vector& ku, Vector& mv) const;
  /// K u and M v at the end of the step, once it is solved.
  Vector& stiff_end() { return filtered_ ? stiff_next_ : stiff_now_; }
  Vector& momentum_end() { return filtered_ ? momentum_next_ : momentum_now_; }
  void right_hand_side(const StepSize& size);
  void begin_filters();
  void shorten_filters(double step);
  void advance_filters(const StepSize& size);
  bool kinematics(const StepSize& size);
  Outcome solve(StepSize& size);
  void book_energies(const StepSize& size);
  void forces_at(const State& state, Vector& result) const;

  const StageModel stage_;
  const ContactChoice contact_;
  const LinearSolver& solver_;
  const StepOptions options_;
  LinearCounts& linear_;
  const bool path_, filtered_;
  const ImpactRule* const impact_;  // null where none acts
  SupportMotion motion_;
  StepSizes sizes_;
  Vector still_force_;  // that do not change in the stage: StepOptions::held and the loads that never change [N, N m]
  double failed_step_ = 0;
  long iterations_before_ = 0;                        // of the interface, before this step
  std::shared_ptr<const SymmetricPair> pair_;         // K and M of large bulks
  mutable std::unique_ptr<Accelerator> accelerator_;  // null while it is not needed
  mutable std::string mass_failure_;                  // why no step can be taken: no factor of M where one is needed
  std::unique_ptr<ContactImpacts> impacts_;           // null where none act
  PlasticBulk yielding_;
  std::unique_ptr<PlasticNewton> newton_;  // null without yielding solids
  PlasticState plastic_now_, plastic_next_;
  std::unique_ptr<JointFilter> joint_filter_;  // null without filters or interfaces
  Vector filtered_stiff_, filtered_momentum_;  // K d_u, M d_v of now_
  double filter_loss_ = 0, filter_store_ = 0;  // b (1 + a)/2, b/(2 (1 - a))
  Vector velocity_before_;                     // at the beginning of the nominal step, of its last one that was divided; path average
  State now_, next_;
  Vector force_now_, force_next_, stiff_now_, momentum_now_;  // f, K u, M v
  Vector stiff_next_, momentum_next_;                         // only filters ask for both ends: empty without them
  Vector increment_;
  mutable Vector right_, work_;  // right-hand side, and work space once a step is solved; of products
  Energies energies_;
  InterfaceEnergy interface_energy_;
  double initial_energy_ = 0, largest_external_ = 0;
  double start_time_ = 0;  // s
  double last_step_ = 0;   // s: of the last part that succeeded; next_ is the state before it
  double origin_ = 0;      // J: what the balance is measured from; the initial energy unless a static stage came in between
  StepCounts counts_;
  std::string why_;
  const InterfaceProblem* last_ = nullptr;
  const InterfaceSolution* solution_ = nullptr;  // of the same solver, or first_try_'s
  double contact_work_ = 0;                      // J: of pressures of constraints in that solution, with impacts
  struct {                                       // with all forces of the beginning, while a solution without some of them is sought
    Vector increment;
    PlasticState plastic;
    InterfaceSolution solution;
  } first_try_;
};

}  // namespace uplift
