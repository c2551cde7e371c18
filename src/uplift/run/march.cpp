#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "uplift/run/largest.h"
#include "uplift/run/runner.h"

namespace uplift {

namespace {

/// What round-off makes of the strain energy [J]: a stiff part that goes with soft ground strains by the difference of large forces.
double sum_round_off(const Sparse& stiffness, const Vector& displacement) {
  double sum = 0;
  for (Index i = 0; i < displacement.size(); ++i) sum += stiffness.coeff(i, i) * displacement[i] * displacement[i];
  return std::numeric_limits<double>::epsilon() * sum;
}

/// Of a dynamic stage; others have none.
long steps_of(const Stage& stage) {
  return stage.type == Stage::Type::dynamics ? std::max(1L, std::lround(stage.duration / stage.step)) : 0;
}

}  // namespace

void Runner::note_views() {
  StepRecord& steps = run_.result.steps;
  steps.add(seen_->time, views_, plan_.gap_tolerance);
  if (seen_->time >= planned_ - tail_) note_poses();
  look_over_bases();
  if (has_walls_) steps.add_slip(model_.interfaces, seen_->opening, plan_.is_wall);
  if (has_strength_) steps.add_strength(views_);
}

[[gnu::noinline]] void Runner::note_poses() {
  for (std::size_t k = 0; k < views_.size(); ++k) run_.result.steps.tail[k].push_back(viewer_.pose(*seen_, k, views_[k]));
}

void Runner::look_over_bases() {
  farthest_ = uplifted_ = 0;
  std::size_t k = 0;
  for (const InterfaceView& view : views_) {
    if (is_wall(k++)) continue;
    farthest_ = std::max(farthest_, view.least_opening);
    uplifted_ = std::max(uplifted_, view.open_area);
  }
}

/// Momentum that impacts of constraints transferred in the last step, of each interface.
void Runner::note_impulses(const Stepper& stepper) {
  if (stepper.impacts() == nullptr) return;
  const Vector& impulse = stepper.impacts()->transferred();
  Index first = 0;
  for (std::size_t k = 0; k < model_.interfaces.size(); ++k) {
    const Batch& batch = model_.interfaces[k].batch;
    const double sum = -impulse.segment(first + batch.normal(), batch.points).sum();
    StepRecord::Reached& most = run_.result.steps.extremes[k].impulse;
    if (sum > most.value) most = {sum, seen_->time};
    first += batch.points * batch.components;
  }
}

/// Peaks and durations of what was noted since this was last called, in a stage with this step.
void Runner::sum_up(double step) {
  const StepRecord& steps = run_.result.steps;
  Peak& ratio = run_.result.max_uplifted_ratio;
  for (; summed_up_ < steps.size(); ++summed_up_) {
    const double time = steps.time[summed_up_];
    bool open = false;
    for (std::size_t k = 0; k < steps.extremes.size(); ++k) {
      if (is_wall(k)) continue;
      const StepRecord::Instant& at = steps.at(summed_up_, k);
      if (at.open_area > ratio.value) ratio.value = at.open_area, ratio.time = time;
      open = open || at.open_area > 0;
    }
    if (!open) continue;
    if (run_.result.first_uplift < 0) run_.result.first_uplift = time;
    if (summed_up_ > 0) run_.result.time_uplifted += step;
  }
  for (std::size_t k = 0; k < steps.extremes.size(); ++k) {
    const StepRecord::Extremes& most = steps.extremes[k];
    run_.result.max_penetration = std::max(run_.result.max_penetration, most.penetration.value);
    if (is_wall(k)) continue;
    const auto take = [](Peak& peak, const StepRecord::Reached& reached) {
      if (reached.value > peak.value) peak.value = reached.value, peak.time = reached.time;
    };
    take(run_.result.max_opening, most.max_opening);
    take(run_.result.max_pressure, most.max_pressure);
  }
  run_.result.full_loss = steps.full_loss_time(plan_.is_wall);
}

/// Energy created and lost by the computation so far (lost: by the filters of the scheme, and what the balance lacks); the scale is the
/// largest external work, or the energy at the beginning where no load works. Work of the dead loads over 1e-10 m (of which the gate takes
/// a hundredth), and 1e-8 of the energy that the static state stores, are round-off: a structure that only stands there has created
/// nothing, though friction under constraints knows its forces to 1e-9 alone.
void Runner::finish_energy(const Stepper& stepper) {
  const Energies& energies = stepper.energies();
  const double created = energies.residual + std::max(0.0, -energies.impact);
  note_largest(created, seen_->time, run_.result.energy_created, run_.result.energy_created_time);
  const double lost = energies.algorithmic - std::min(0.0, energies.residual);
  note_largest(lost, seen_->time, run_.result.energy_lost, run_.result.energy_lost_time);
  run_.result.energy_scale = std::max(stepper.largest_external(), run_.initial_scale);
  if (run_.result.energy_scale <= 0) run_.result.energy_scale = stepper.initial_energy();
  run_.result.energy_scale = std::max(run_.result.energy_scale, run_.round_off_energy);
}

/// The present instant in messages.
std::string Runner::when() const {
  return static_share_ ? fmt::format("{:.4g} % of the static load", 100 * *static_share_) : fmt::format("t = {:.6g} s", seen_->time);
}

/// False when the run ends here: not finite, far beyond the energy limit, or moved beyond the small-displacement model.
bool Runner::check_limits(const Stepper& stepper) {
  const Energies& energies = stepper.energies();
  if (!std::isfinite(energies.residual) || !std::isfinite(energies.kinetic)) {
    fail(fmt::format("the energy is not finite at t = {:.6g} s", seen_->time), stepper.problem());
    return false;
  }
  const bool creates = run_.result.energy_scale > 0 && run_.result.energy_created > plan_.created_limit * run_.result.energy_scale;
  if (creates && (plan_.stop_at_limit || run_.result.energy_created > 1e6 * run_.result.energy_scale)) return false;
  if (creates) return true;
  return moves_little(model_, rotations_);
}

/// False when a body or a surface has moved beyond the small-displacement model: then the status says so.
bool Runner::moves_little(const Model& model, const std::vector<int>& rotations) {
  for (int unknown : rotations)
    if (std::abs(seen_->displacement[unknown]) > plan_.rotation_limit) {
      overturn(model, unknown);
      return false;
    }
  return (!rotations.empty() || surfaces_turn_little()) &&
         (plan_.separation_limit <= 0 || farthest_ <= plan_.separation_limit || surfaces_stay_near());
}

[[gnu::cold]] void Runner::overturn(const Model& model, int unknown) {
  run_.result.status = RunStatus::overturned;
  run_.result.reason = fmt::format("{} passed {:.3g} rad at {}, the limit of the small-displacement model", model.unknown_name(unknown),
                                   plan_.rotation_limit, when());
}

/// Nodes of solids do not turn: there the slope of the opening's best plane is what the building has turned against the soil.
bool Runner::surfaces_turn_little() {
  for (std::size_t k = 0; k < model_.interfaces.size(); ++k) {
    if (is_wall(k)) continue;
    const std::array<double, 2>& slope = views_[k].rotation;
    if (!(std::hypot(slope[0], slope[1]) > plan_.rotation_limit)) continue;
    run_.result.status = RunStatus::overturned;
    run_.result.reason = fmt::format("'{}' passed a slope of {:.3g} rad between its sides at {}, the limit of the small-displacement model",
                                     model_.interfaces[k].name, plan_.rotation_limit, when());
    return false;
  }
  return true;
}

/// A body may also leave the ground without turning.
bool Runner::surfaces_stay_near() {
  for (std::size_t k = 0; k < model_.interfaces.size(); ++k) {
    const Interface& interface = model_.interfaces[k];
    if (is_wall(k)) continue;
    if (!(views_[k].least_opening > plan_.separation_limit)) continue;
    if (!(views_[k].least_opening - interface.gap.maxCoeff() > plan_.separation_limit)) continue;
    run_.result.status = RunStatus::separated;
    run_.result.reason = fmt::format("'{}' is open everywhere by more than {:.3g} m at {}, the limit of the small-displacement model",
                                     interface.name, plan_.separation_limit, when());
    return false;
  }
  return true;
}

/// Hands out the state of the run after this step of the stage. The run goes on as one that begins there.
void Runner::keep(Stepper& stepper, Recorder& recorder, EquilibriumCheck& equilibrium, long step) {
  stepper.reenter();
  recorder.keep(run_);
  equilibrium.finish(run_.result.equilibrium);
  sum_up(plan_.stages[run_.stage].step);
  run_.step = step;
  run_.march = stepper.march_state();
  keeping_.keep(run_);
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

/// Puts the stepper where the stage begins or goes on.
void Runner::start(const Stage& stage, const LinearCounts& counts, Stepper& stepper) {
  if (run_.step > 0) {
    stepper.resume(std::move(run_.march));
    run_.linear = counts;  // what is factorised again has been counted
    return;
  }
  const auto carries_on = [&] {  // the accelerations of the stage before are those of the same scheme
    if (!run_.marched) return false;
    const Stage& before = plan_.stages[*run_.marched];
    return before.p_delta == stage.p_delta && before.scheme == stage.scheme;
  };
  if (run_.ledger && !carries_on()) run_.ledger->acceleration = false;
  stepper.start(std::move(run_.state), run_.ledger ? &*run_.ledger : nullptr);
}

/// What the energy error of the dynamic stages is held against.
void Runner::begin_scales(const Stepper& stepper, const Bulk& bulk) {
  if (!run_.ledger) {
    const Energies& energies = stepper.energies();
    run_.initial_scale = energies.kinetic;
    run_.round_off_energy = 1e-8 * (energies.strain + energies.stored) / (plan_.created_limit > 0 ? std::min(plan_.created_limit, 1.0) : 1);
    run_.round_off_energy += 100 * sum_round_off(bulk.stiffness_matrix, stepper.state().displacement);
  }
  for (const TimeLoad& time_load : model_.time_loads)
    if (time_load.dead)
      run_.round_off_energy += 1e-10 * time_load.shape.lpNorm<1>() * std::abs(time_load.function->value(stepper.state().time));
}

bool Runner::dynamics(const Stage& stage, const Bulk& bulk) {
  const LinearCounts counts = run_.linear;
  Stepper stepper({model_, bulk, b_, gap_}, {*laws_, *plan_.method}, *plan_.impact, *plan_.solver, step_options(stage), run_.linear);
  start(stage, counts, stepper);
  seen_ = &stepper.state();
  run_.result.step_means = run_.result.step_means || stepper.averages_acceleration();
  const long steps = steps_of(stage), begin = run_.step;
  long steps_before = 0, all_steps = 0;  // of all dynamic stages
  for (std::size_t k = 0; k < plan_.stages.size(); ++k) {
    if (k == run_.stage) steps_before = all_steps;
    all_steps += steps_of(plan_.stages[k]);
  }
  const ForceStage force_stage = this->force_stage(stage);
  Recorder recorder(model_, plan_, *seen_, stepper.energies(), &stepper, views_, force_stage, steps, stage.step, run_.result);
  EquilibriumCheck equilibrium(force_stage);
  constexpr long checks = 4;  // of the equilibrium in a stage
  const long picture_every = plan_.frames > 0 ? std::max(1L, steps / plan_.frames) : 0;
  const auto observe = [&](long step) {
    viewer_.look(*seen_, views_, radiation_.forces(stepper));
    note_views();
    note_impulses(stepper);
    recorder.record(step % plan_.every == 0 || step == steps);
    if (picture_every > 0) recorder.note_uplift(uplifted_);
    if (picture_every > 0 && step % picture_every == 0) recorder.picture(*seen_);
  };
  run_.result.steps.reserve(model_.interfaces.size(), static_cast<std::size_t>(steps) + 1,
                            static_cast<std::size_t>(std::min(static_cast<double>(steps) + 1, tail_ / stage.step + 2)));
  if (begin > 0) {
    recorder.resume(run_);
  } else {
    run_.next_check = 1;
    begin_scales(stepper, bulk);
    if (!run_.ledger) {  // else the end of the stage before is there already
      observe(0);
      show(stage, &stepper, 0, false);
    }
  }
  bool go_on = true;
  // steps from one report of progress to the next; an observer may want to end the run after any step
  const long between = observe_ ? 1 : bulk.small ? 256 : 8;
  auto first_done = std::chrono::steady_clock::now();
  double shown_before = shown_;
  for (long step = begin + 1; step <= steps && go_on; ++step) {
    if (!stepper.advance()) {
      fail(fmt::format("step at t = {:.6g} s failed down to dt = {:.3g} s: {}", seen_->time, stepper.failed_step(), stepper.why()),
           stepper.problem());
      show(stage, &stepper, step - 1, true);
      break;
    }
    finish_energy(stepper);
    observe(step);
    if (step * checks >= run_.next_check * steps) equilibrium.note(stepper.balance({})), ++run_.next_check;
    go_on = check_limits(stepper);
    if (step == begin + 1) first_done = std::chrono::steady_clock::now(), shown_before = shown_;
    if (keeping_.follow && step % between == 0) keeping_.follow(run_.result);
    if (watch_ && step % between == 0 && go_on) {
      const double open = views_.empty() ? 0 : views_.front().open_area;
      const double scale = run_.result.energy_scale > 0 ? run_.result.energy_scale : 1;
      if (!watch_({static_cast<double>(steps_before + step) / static_cast<double>(all_steps), seen_->time, stage.step, open,
                   stepper.energies().residual / scale})) {
        run_.result.status = RunStatus::interrupted;
        run_.result.reason = fmt::format("interrupted at t = {:.6g} s", seen_->time);
        go_on = false;
      }
    }
    show(stage, &stepper, step, step == steps || !go_on);
    if (keeping_.keep && step % keeping_.every == 0 && step < steps && go_on) keep(stepper, recorder, equilibrium, step);
  }
  if (stepper.counts().steps > begin + 1)
    run_.result.step_seconds =
        (std::chrono::duration<double>(std::chrono::steady_clock::now() - first_done).count() - (shown_ - shown_before)) /
        static_cast<double>(stepper.counts().steps - begin - 1);
  recorder.finish();
  equilibrium.finish(run_.result.equilibrium);
  sum_up(stage.step);
  run_.state = stepper.whole_state();
  seen_ = &run_.state;
  run_.ledger = stepper.handover();
  run_.marched = run_.stage;
  run_.result.counts.steps += stepper.counts().steps;
  run_.result.counts.retries += stepper.counts().retries;
  run_.result.counts.iterations += stepper.counts().iterations;
  run_.result.counts.cycles += stepper.counts().cycles;
  run_.result.final_energy = stepper.energies();
  run_.result.end_time = seen_->time;
  if (stepper.counts().deepest > 0)
    run_.result.notes.push_back(
        fmt::format("the step was halved up to {} times ({} retries)", stepper.counts().deepest, stepper.counts().retries));
  if (stepper.counts().cycles > 0)
    run_.result.notes.push_back(fmt::format("{} cycles of the contact status were met and treated", stepper.counts().cycles));
  const bool creates = run_.result.energy_scale > 0 && run_.result.energy_created > plan_.created_limit * run_.result.energy_scale;
  if (creates && run_.result.status != RunStatus::interrupted && run_.result.status != RunStatus::failed) {
    run_.result.status = RunStatus::failed;
    run_.result.reason = fmt::format("energy was created: {} of the external work (limit {:.3g} %), at t = {:.6g} s",
                                     run_.result.created_percent(), 100 * plan_.created_limit, run_.result.energy_created_time);
  }
  return go_on && run_.result.status == RunStatus::completed;
}

}  // namespace uplift
