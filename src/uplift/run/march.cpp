#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "uplift/model/numbering.h"
#include "uplift/run/largest.h"
#include "uplift/run/runner.h"

namespace uplift {

namespace {

/// What round-off makes of the strain energy [J]: a stiff part that goes with soft ground strains by the difference of large forces.
double sum_round_off(const Vector& stiffness, const Vector& displacement) {
  double sum = 0;
  for (Index i = 0; i < displacement.size(); ++i) sum += stiffness[i] * displacement[i] * displacement[i];
  return std::numeric_limits<double>::epsilon() * sum;
}

/// Of a dynamic stage; others have none.
long steps_of(const Stage& stage) {
  return stage.type == Stage::Type::dynamics ? std::max(1L, std::lround(stage.duration / stage.step)) : 0;
}

}  // namespace

/// The march through one dynamic stage.
class Runner::March {
 public:
  March(Runner& runner, const Stage& stage, const Bulk& bulk);
  March(const March&) = delete;  // the recorder refers to it
  March& operator=(const March&) = delete;
  /// Every step, up to the end of the stage or of the run; false when the run ends here.
  bool go();

 private:
  using Clock = std::chrono::steady_clock;
  const State& start();
  void begin();
  void begin_scales();
  bool advance(long step);
  void note(long step);
  void finish_energy();
  bool creates() const { return result_.energy_scale > 0 && result_.energy_created > runner_.plan_.created_limit * result_.energy_scale; }
  bool within_limits();
  bool report(long step);
  void keep(long step);
  void end();

  Runner& runner_;
  RunState& run_;
  RunResult& result_;
  const Stage& stage_;
  const Bulk& bulk_;
  const LinearCounts counts_;  // before the stage
  const long steps_, first_;   // of the stage; those that are done when it begins
  Stepper stepper_;
  const State& state_;  // the stepper's present one: it is started, or goes on, here
  const ForceStage forces_;
  Recorder recorder_;
  EquilibriumCheck equilibrium_;
  const long picture_every_;  // steps; 0: there are none
  // Steps from one report of progress to the next; an observer may want to end the run after any step.
  const long between_ = runner_.observe_ ? 1 : bulk_.small ? 256 : 8;
  Clock::time_point first_done_ = Clock::now();  // of the steps of this run
  double shown_before_;                          // s: what the observer had taken then
};

bool Runner::dynamics(const Stage& stage, const Bulk& bulk) {
  return March(*this, stage, bulk).go();
}

Runner::March::March(Runner& runner, const Stage& stage, const Bulk& bulk)
    : runner_(runner),
      run_(runner.run_),
      result_(run_.result),
      stage_(stage),
      bulk_(bulk),
      counts_(run_.linear),
      steps_(steps_of(stage)),
      first_(run_.step),
      stepper_({runner.model_, bulk, runner.b_, runner.gap_}, {*runner.laws_, *runner.plan_.method}, *runner.plan_.impact,
               *runner.plan_.solver, runner.step_options(stage), run_.linear),
      state_(start()),
      forces_(runner.force_stage(stage)),
      recorder_(runner.model_, runner.plan_, state_, stepper_.energies(), &stepper_, runner.bases_.views(), forces_, steps_, stage.step,
                result_),
      equilibrium_(forces_),
      picture_every_(runner.plan_.frames > 0 ? std::max(1L, steps_ / runner.plan_.frames) : 0),
      shown_before_(runner.shown_) {}

/// Puts the stepper where the stage begins or goes on.
const State& Runner::March::start() {
  if (first_ > 0) {
    stepper_.resume(std::move(run_.march));
    run_.linear = counts_;  // what is factorised again has been counted
    return stepper_.state();
  }
  const auto carries_on = [&] {  // the accelerations of the stage before are those of the same scheme
    if (!run_.marched) return false;
    const Stage& before = runner_.plan_.stages[*run_.marched];
    return before.p_delta == stage_.p_delta && before.scheme == stage_.scheme;
  };
  if (run_.handover && !carries_on()) run_.handover->acceleration = false;
  stepper_.start(std::move(run_.state), run_.handover ? &*run_.handover : nullptr);
  return stepper_.state();
}

bool Runner::March::go() {
  begin();
  bool goes_on = true;
  for (long step = first_ + 1; step <= steps_ && goes_on; ++step) goes_on = advance(step);
  end();
  return goes_on && result_.status == RunStatus::completed;
}

void Runner::March::begin() {
  runner_.seen_ = &state_;
  result_.step_means = result_.step_means || stepper_.averages_acceleration();
  runner_.bases_.reserve(steps_, stage_.step);
  if (first_ > 0) return recorder_.resume(run_);
  run_.next_check = 1;
  begin_scales();
  if (run_.handover) return;  // the end of the stage before is there already
  note(0);
  runner_.show(stage_, &stepper_, 0, false);
}

/// What the energy error of the dynamic stages is held against.
void Runner::March::begin_scales() {
  if (!run_.handover) {
    const Energies& energies = stepper_.energies();
    run_.initial_scale = energies.kinetic;
    run_.round_off_energy =
        1e-8 * (energies.strain + energies.stored) / (runner_.plan_.created_limit > 0 ? std::min(runner_.plan_.created_limit, 1.0) : 1);
    run_.round_off_energy += 100 * sum_round_off(bulk_.stiffness_diagonal(), state_.displacement);
  }
  for (const TimeLoad& time_load : runner_.model_.time_loads)
    if (time_load.dead) run_.round_off_energy += 1e-10 * time_load.shape.lpNorm<1>() * std::abs(time_load.function->value(state_.time));
}

/// One step; false when the run ends with it.
inline bool Runner::March::advance(long step) {
  constexpr long checks = 4;  // of the equilibrium in a stage
  if (!stepper_.advance()) {
    runner_.fail(fmt::format("step at t = {:.6g} s failed down to dt = {:.3g} s: {}", state_.time, stepper_.failed_step(), stepper_.why()),
                 stepper_.problem());
    runner_.show(stage_, &stepper_, step - 1, true);
    return false;
  }
  finish_energy();
  note(step);
  if (step * checks >= run_.next_check * steps_) equilibrium_.note(stepper_.balance({})), ++run_.next_check;
  bool goes_on = within_limits();
  if (step == first_ + 1) first_done_ = Clock::now(), shown_before_ = runner_.shown_;
  const Keeping& keeping = runner_.keeping_;
  if (keeping.follow && step % between_ == 0) keeping.follow(result_);
  if (runner_.watch_ && step % between_ == 0 && goes_on) goes_on = report(step);
  runner_.show(stage_, &stepper_, step, step == steps_ || !goes_on);
  if (keeping.keep && step % keeping.every == 0 && step < steps_ && goes_on) keep(step);
  return goes_on;
}

inline void Runner::March::note(long step) {
  runner_.bases_.note(stepper_);
  recorder_.record(step % runner_.plan_.every == 0 || step == steps_);
  if (picture_every_ > 0) recorder_.note_uplift(runner_.bases_.uplifted());
  if (picture_every_ > 0 && step % picture_every_ == 0) recorder_.picture(state_);
}

/// Energy created and lost by the computation so far (lost: by the filters of the scheme, and what the balance lacks); the scale is the
/// largest external work, or the energy at the beginning where no load works. Work of the dead loads over 1e-10 m (of which the gate takes
/// a hundredth), and 1e-8 of the energy that the static state stores, are round-off: a structure that only stands there has created
/// nothing, though friction under constraints knows its forces to 1e-9 alone.
inline void Runner::March::finish_energy() {
  const Energies& energies = stepper_.energies();
  const double created = energies.residual + std::max(0.0, -energies.impact);
  note_largest(created, state_.time, result_.energy_created, result_.energy_created_time);
  const double lost = energies.algorithmic - std::min(0.0, energies.residual);
  note_largest(lost, state_.time, result_.energy_lost, result_.energy_lost_time);
  result_.energy_scale = std::max(stepper_.largest_external(), run_.initial_scale);
  if (result_.energy_scale <= 0) result_.energy_scale = stepper_.initial_energy();
  result_.energy_scale = std::max(result_.energy_scale, run_.round_off_energy);
}

/// False when the run ends here: not finite, far beyond the energy limit, or moved beyond the small-displacement model.
inline bool Runner::March::within_limits() {
  const Energies& energies = stepper_.energies();
  if (!std::isfinite(energies.residual) || !std::isfinite(energies.kinetic)) {
    runner_.fail(fmt::format("the energy is not finite at t = {:.6g} s", state_.time), stepper_.problem());
    return false;
  }
  if (creates()) return !runner_.plan_.stop_at_limit && result_.energy_created <= 1e6 * result_.energy_scale;
  return runner_.bases_.moves_little(state_, runner_.model_, runner_.rotations_);
}

/// Tells the watch how far the run is; false when it wants the run to end.
bool Runner::March::report(long step) {
  long before = 0, all = 0;  // steps of the dynamic stages
  for (std::size_t k = 0; k < runner_.plan_.stages.size(); ++k) {
    if (k == run_.stage) before = all;
    all += steps_of(runner_.plan_.stages[k]);
  }
  const std::vector<InterfaceView>& views = runner_.bases_.views();
  const double open = views.empty() ? 0 : views.front().open_area, scale = result_.energy_scale > 0 ? result_.energy_scale : 1;
  if (runner_.watch_({static_cast<double>(before + step) / static_cast<double>(all), state_.time, stage_.step, open,
                      stepper_.energies().residual / scale}))
    return true;
  result_.status = RunStatus::interrupted;
  result_.reason = fmt::format("interrupted at t = {:.6g} s", state_.time);
  return false;
}

/// Hands out the state of the run after this step of the stage. The run goes on as one that begins there.
void Runner::March::keep(long step) {
  stepper_.reenter();
  recorder_.keep(run_);
  equilibrium_.finish(result_.equilibrium);
  runner_.bases_.sum_up(stage_.step);
  run_.step = step;
  run_.march = stepper_.march_state();
  const std::vector<int> number = numbers_by_nodes(runner_.model_);
  if (number.empty()) return runner_.keeping_.keep(run_);
  renumber(number, run_);  // for as long as it is handed out: tables and frames make a copy dear
  runner_.keeping_.keep(run_);
  renumber(inverse(number), run_);
}

/// Hands on to the next stage.
void Runner::March::end() {
  const StepCounts& counts = stepper_.counts();
  if (counts.steps > first_ + 1)
    result_.step_seconds = (std::chrono::duration<double>(Clock::now() - first_done_).count() - (runner_.shown_ - shown_before_)) /
                           static_cast<double>(counts.steps - first_ - 1);
  recorder_.finish();
  equilibrium_.finish(result_.equilibrium);
  runner_.bases_.sum_up(stage_.step);
  run_.state = stepper_.whole_state();
  runner_.seen_ = &run_.state;
  run_.handover = stepper_.handover();
  run_.marched = run_.stage;
  result_.counts.steps += counts.steps;
  result_.counts.retries += counts.retries;
  result_.counts.iterations += counts.iterations;
  result_.counts.cycles += counts.cycles;
  result_.final_energy = stepper_.energies();
  result_.end_time = run_.state.time;
  if (counts.deepest > 0)
    result_.notes.push_back(fmt::format("the step was halved up to {} times ({} retries)", counts.deepest, counts.retries));
  if (counts.cycles > 0) result_.notes.push_back(fmt::format("{} cycles of the contact status were met and treated", counts.cycles));
  if (!creates() || result_.status == RunStatus::interrupted || result_.status == RunStatus::failed) return;
  result_.status = RunStatus::failed;
  result_.reason = fmt::format("energy was created: {} of the external work (limit {:.3g} %), at t = {:.6g} s", result_.created_percent(),
                               100 * runner_.plan_.created_limit, result_.energy_created_time);
}

StepOptions Runner::step_options(const Stage& stage) const {
  StepOptions options;
  options.scheme = stage.scheme;
  options.step = stage.step;
  options.path_average = stage.path_average;
  options.halvings = stage.halvings;
  options.monolithic = plan_.monolithic;
  options.oracle_tolerance = plan_.oracle_tolerance;
  if (run_.held.size() > 0) options.held = &run_.held;
  if (stage.p_delta && !second_order_loads_.empty()) options.second_order = &second_order_loads_;
  return options;
}

}  // namespace uplift
