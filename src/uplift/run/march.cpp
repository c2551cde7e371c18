#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "uplift/run/runner.h"

namespace uplift {

namespace {

/// What round-off makes of the strain energy [J]: a stiff part that goes with soft ground strains by the difference of large forces.
double sum_round_off(const Sparse& stiffness, const Vector& displacement) {
  double sum = 0;
  for (Index i = 0; i < displacement.size(); ++i) sum += stiffness.coeff(i, i) * displacement[i] * displacement[i];
  return std::numeric_limits<double>::epsilon() * sum;
}

}  // namespace

void Runner::note_views() {
  StepRecord& steps = result_.steps;
  steps.add(seen_->time, views_, plan_.gap_tolerance);
  if (seen_->time >= planned_ - tail_)
    for (std::size_t k = 0; k < views_.size(); ++k) steps.tail[k].push_back(viewer_.pose(*seen_, k, views_[k]));
  find_farthest();
  if (has_walls_) steps.add_slip(model_.interfaces, seen_->opening, plan_.is_wall);
}

void Runner::find_farthest() {
  farthest_ = 0;
  for (std::size_t k = 0; k < views_.size(); ++k)
    if (!is_wall(k)) farthest_ = std::max(farthest_, views_[k].least_opening);
}

/// Momentum that impacts of constraints transferred in the last step, of each interface.
void Runner::note_impulses(const Stepper& stepper) {
  const Vector& impulse = stepper.impact_impulse();
  if (impulse.size() == 0) return;
  Index first = 0;
  for (std::size_t k = 0; k < model_.interfaces.size(); ++k) {
    const Batch& batch = model_.interfaces[k].batch;
    const double sum = -impulse.segment(first + batch.normal(), batch.points).sum();
    StepRecord::Reached& most = result_.steps.extremes[k].impulse;
    if (sum > most.value) most = {sum, seen_->time};
    first += batch.points * batch.components;
  }
}

/// Peaks and durations of what was noted since this was last called, in a stage with this step.
void Runner::sum_up(double step) {
  const StepRecord& steps = result_.steps;
  Peak& ratio = result_.max_uplifted_ratio;
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
    if (result_.first_uplift < 0) result_.first_uplift = time;
    if (summed_up_ > 0) result_.time_uplifted += step;
  }
  for (std::size_t k = 0; k < steps.extremes.size(); ++k) {
    const StepRecord::Extremes& most = steps.extremes[k];
    result_.max_penetration = std::max(result_.max_penetration, most.penetration.value);
    if (is_wall(k)) continue;
    const auto take = [](Peak& peak, const StepRecord::Reached& reached) {
      if (reached.value > peak.value) peak.value = reached.value, peak.time = reached.time;
    };
    take(result_.max_opening, most.max_opening);
    take(result_.max_pressure, most.max_pressure);
  }
  result_.full_loss = steps.full_loss_time(plan_.is_wall);
}

/// Energy created and lost by the computation so far (lost: by the filters of the scheme, and what the balance lacks); the scale is the
/// largest external work, or the energy at the beginning where no load works. Work of the dead loads over 1e-10 m, and 1e-8 of the energy
/// that the static state stores (of which the gate takes a hundredth), are round-off: a structure that only stands there has created
/// nothing.
void Runner::finish_energy(const Stepper& stepper) {
  const Energies& energies = stepper.energies();
  const double created = energies.residual + std::max(0.0, -energies.impact);
  if (created > result_.energy_created) result_.energy_created = created, result_.energy_created_time = seen_->time;
  const double lost = energies.algorithmic - std::min(0.0, energies.residual);
  if (lost > result_.energy_lost) result_.energy_lost = lost, result_.energy_lost_time = seen_->time;
  result_.energy_scale = std::max(stepper.largest_external(), initial_scale_);
  if (result_.energy_scale <= 0) result_.energy_scale = stepper.initial_energy();
  result_.energy_scale = std::max(result_.energy_scale, round_off_energy_);
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
  const bool creates = result_.energy_scale > 0 && result_.energy_created > plan_.created_limit * result_.energy_scale;
  if (creates && (plan_.stop_at_limit || result_.energy_created > 1e6 * result_.energy_scale)) return false;
  if (creates) return true;
  return moves_little(model_, rotations_);
}

/// False when a body or a surface has moved beyond the small-displacement model: then the status says so.
bool Runner::moves_little(const Model& model, const std::vector<int>& rotations) {
  for (int unknown : rotations)
    if (std::abs(seen_->displacement[unknown]) > plan_.rotation_limit) {
      result_.status = RunStatus::overturned;
      result_.reason = fmt::format("{} passed {:.3g} rad at {}, the limit of the small-displacement model",
                                   model.unknown_names[static_cast<std::size_t>(unknown)], plan_.rotation_limit, when());
      return false;
    }
  return (!rotations.empty() || surfaces_turn_little()) &&
         (plan_.separation_limit <= 0 || farthest_ <= plan_.separation_limit || surfaces_stay_near());
}

/// Nodes of solids do not turn: there the slope of the opening's best plane is what the building has turned against the soil.
bool Runner::surfaces_turn_little() {
  for (std::size_t k = 0; k < model_.interfaces.size(); ++k) {
    if (is_wall(k)) continue;
    const std::array<double, 2>& slope = views_[k].rotation;
    if (!(std::hypot(slope[0], slope[1]) > plan_.rotation_limit)) continue;
    result_.status = RunStatus::overturned;
    result_.reason = fmt::format("'{}' passed a slope of {:.3g} rad between its sides at {}, the limit of the small-displacement model",
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
    result_.status = RunStatus::separated;
    result_.reason = fmt::format("'{}' is open everywhere by more than {:.3g} m at {}, the limit of the small-displacement model",
                                 interface.name, plan_.separation_limit, when());
    return false;
  }
  return true;
}

bool Runner::dynamics(const Stage& stage, const Bulk& bulk) {
  StepOptions options;
  options.scheme = stage.scheme;
  options.step = stage.step;
  options.path_average = stage.path_average;
  options.halvings = stage.halvings;
  options.monolithic = plan_.monolithic;
  options.oracle_tolerance = plan_.oracle_tolerance;
  if (held_.size() > 0) options.held = &held_;
  if (stage.p_delta && !second_order_loads_.empty()) options.second_order = &second_order_loads_;
  if (ledger_ && !(march_ && march_->p_delta == stage.p_delta && march_->scheme == stage.scheme)) ledger_->acceleration = false;
  Stepper stepper(model_, bulk, b_, gap_, *laws_, *plan_.method, *plan_.impact, *plan_.solver, options, linear_);
  stepper.start(std::move(state_), ledger_ ? &*ledger_ : nullptr);
  seen_ = &stepper.state();
  result_.step_means = result_.step_means || stepper.averages_acceleration();
  const long steps = std::max(1L, std::lround(stage.duration / stage.step));
  const ForceStage force_stage = this->force_stage(stage);
  Recorder recorder(model_, plan_, *seen_, stepper.energies(), &stepper, views_, force_stage, steps, stage.step, result_);
  EquilibriumCheck equilibrium(force_stage);
  constexpr long checks = 4;  // of the equilibrium in a stage
  long next_check = 1;
  const long picture_every = plan_.frames > 0 ? std::max(1L, steps / plan_.frames) : 0;
  if (!ledger_) initial_scale_ = stepper.energies().kinetic;
  if (!ledger_) round_off_energy_ = 1e-8 * (stepper.energies().strain + stepper.energies().stored);
  if (!ledger_) round_off_energy_ += 100 * sum_round_off(bulk.stiffness_matrix, stepper.state().displacement);
  for (const TimeLoad& time_load : model_.time_loads)
    if (time_load.dead) round_off_energy_ += 1e-10 * time_load.shape.lpNorm<1>() * std::abs(time_load.function->value(seen_->time));
  const auto observe = [&](long step) {
    viewer_.look(seen_->opening, seen_->mean_force, views_);
    note_views();
    note_impulses(stepper);
    recorder.record(step % plan_.every == 0 || step == steps);
    if (picture_every > 0) recorder.note_largest_uplift();
    if (picture_every > 0 && step % picture_every == 0) recorder.picture(*seen_);
  };
  result_.steps.reserve(model_.interfaces.size(), static_cast<std::size_t>(steps) + 1,
                        static_cast<std::size_t>(std::min(static_cast<double>(steps) + 1, tail_ / stage.step + 2)));
  if (!ledger_) {  // else the end of the stage before is there already
    observe(0);
    show(stage, &stepper, 0, false);
  }
  bool go_on = true;
  // steps from one report of progress to the next; an observer may want to end the run after any step
  const long between = observe_ ? 1 : bulk.small ? 256 : 8;
  auto first_done = std::chrono::steady_clock::now();
  double shown_before = shown_;
  for (long step = 1; step <= steps && go_on; ++step) {
    if (!stepper.advance()) {
      fail(fmt::format("step at t = {:.6g} s failed down to dt = {:.3g} s: {}", seen_->time, stepper.failed_step(), stepper.why()),
           stepper.problem());
      show(stage, &stepper, step - 1, true);
      break;
    }
    finish_energy(stepper);
    observe(step);
    if (step * checks >= next_check * steps) equilibrium.note(stepper.balance({})), ++next_check;
    go_on = check_limits(stepper);
    if (step == 1) first_done = std::chrono::steady_clock::now(), shown_before = shown_;
    if (watch_ && step % between == 0 && go_on) {
      const double open = views_.empty() ? 0 : views_.front().open_area;
      const double scale = result_.energy_scale > 0 ? result_.energy_scale : 1;
      if (!watch_({static_cast<double>(step) / static_cast<double>(steps), seen_->time, stage.step, open,
                   stepper.energies().residual / scale})) {
        result_.status = RunStatus::interrupted;
        result_.reason = fmt::format("interrupted at t = {:.6g} s", seen_->time);
        go_on = false;
      }
    }
    show(stage, &stepper, step, step == steps || !go_on);
  }
  if (stepper.counts().steps > 1)
    result_.step_seconds =
        (std::chrono::duration<double>(std::chrono::steady_clock::now() - first_done).count() - (shown_ - shown_before)) /
        static_cast<double>(stepper.counts().steps - 1);
  recorder.finish();
  equilibrium.finish(result_.equilibrium);
  sum_up(stage.step);
  state_ = stepper.state();
  seen_ = &state_;
  ledger_ = stepper.ledger();
  march_ = stage;
  result_.counts.steps += stepper.counts().steps;
  result_.counts.retries += stepper.counts().retries;
  result_.counts.iterations += stepper.counts().iterations;
  result_.counts.cycles += stepper.counts().cycles;
  result_.final_energy = stepper.energies();
  result_.end_time = seen_->time;
  if (stepper.counts().deepest > 0)
    result_.notes.push_back(
        fmt::format("the step was halved up to {} times ({} retries)", stepper.counts().deepest, stepper.counts().retries));
  if (stepper.counts().cycles > 0)
    result_.notes.push_back(fmt::format("{} cycles of the contact status were met and treated", stepper.counts().cycles));
  const bool creates = result_.energy_scale > 0 && result_.energy_created > plan_.created_limit * result_.energy_scale;
  if (creates && result_.status != RunStatus::interrupted && result_.status != RunStatus::failed) {
    result_.status = RunStatus::failed;
    result_.reason = fmt::format("energy was created: {} of the external work (limit {:.3g} %), at t = {:.6g} s", result_.created_percent(),
                                 100 * plan_.created_limit, result_.energy_created_time);
  }
  return go_on && result_.status == RunStatus::completed;
}

}  // namespace uplift
