#include "uplift/run/base_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "uplift/laws/macro_element.h"

namespace uplift {

BaseWatch::BaseWatch(const Model& model, const RunPlan& plan, const Sparse& b, RunResult& result)
    : model_(model),
      plan_(plan),
      result_(result),
      viewer_(model, plan.gap_tolerance, plan.bases, plan.facets),
      radiation_(model, b),
      views_(model.interfaces.size()) {
  has_walls_ = std::ranges::any_of(plan.is_wall, [](char wall) { return wall != 0; });
  has_strength_ = std::ranges::any_of(model.interfaces, [](const Interface& interface) {
    const MacroElement* foundation = as_macro_element(interface.law.get());
    return foundation != nullptr && (foundation->surfaces().has_bearing() || foundation->surfaces().has_sliding());
  });
  double planned = 0;
  for (const Stage& stage : plan.stages) planned += stage.type == Stage::Type::dynamics ? stage.duration : 0;
  if (const Stage* dynamic = dynamic_stage(plan)) tail_ = 0.1 * planned + 0.5 * dynamic->step;
  tail_begin_ = planned - tail_;
}

void BaseWatch::reserve(long steps, double step) {
  const double instants = static_cast<double>(steps) + 1;
  result_.steps.reserve(model_.interfaces.size(), static_cast<std::size_t>(instants),
                        static_cast<std::size_t>(std::min(instants, tail_ / step + 2)));
}

void BaseWatch::look(const State& state, const Vector* radiation) {
  viewer_.look(state, views_, radiation);
  farthest_ = uplifted_ = 0;
  std::size_t k = 0;
  for (const InterfaceView& view : views_) {
    if (is_wall(k++)) continue;
    farthest_ = std::max(farthest_, view.least_opening);
    uplifted_ = std::max(uplifted_, view.open_area);
  }
}

void BaseWatch::note(const State& state, const Vector* radiation) {
  look(state, radiation);
  StepRecord& steps = result_.steps;
  steps.add(state.time, views_, plan_.gap_tolerance);
  if (state.time >= tail_begin_) note_poses(state);
  if (has_walls_) steps.add_slip(model_.interfaces, state.opening, plan_.is_wall);
  if (has_strength_) steps.add_strength(views_);
}

[[gnu::noinline]] void BaseWatch::note_poses(const State& state) {
  for (std::size_t k = 0; k < views_.size(); ++k) result_.steps.tail[k].push_back(viewer_.pose(state, k, views_[k]));
}

void BaseWatch::note(const Stepper& stepper) {
  note(stepper.state(), radiation_.forces(stepper));
  note_impulses(stepper);
}

/// Momentum that impacts of constraints transferred in the last step, of each interface.
inline void BaseWatch::note_impulses(const Stepper& stepper) {
  if (stepper.impacts() == nullptr || stepper.impacts()->transferred() == nullptr) return;
  const Vector& impulse = *stepper.impacts()->transferred();
  Index first = 0;
  for (std::size_t k = 0; k < model_.interfaces.size(); ++k) {
    const Batch& batch = model_.interfaces[k].batch;
    const double sum = -impulse.segment(first + batch.normal(), batch.points).sum();
    StepRecord::Reached& most = result_.steps.extremes[k].impulse;
    if (sum > most.value) most = {sum, stepper.state().time};
    first += batch.points * batch.components;
  }
}

void BaseWatch::note_rest(const State& state) {
  look(state);
  for (std::size_t k = 0; k < views_.size(); ++k) {
    result_.steps.rest.push_back(views_[k].resultant);
    result_.steps.rest_poses.push_back(viewer_.pose(state, k, views_[k]));
  }
}

void BaseWatch::sum_up(double step) {
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

void BaseWatch::finish() {
  StepRecord& steps = result_.steps;
  steps.average(plan_.window);
  result_.max_step_pressure = result_.max_pressure;
  for (Peak* peak : {&result_.max_base_moment, &result_.max_base_shear, &result_.max_pressure}) peak->value = peak->time = 0;
  const auto note = [](Peak& peak, double value, double time) {
    if (std::abs(value) > std::abs(peak.value)) peak.value = value, peak.time = time;
  };
  const bool plane = model_.space.dimension == 2;
  double force = 0, moment = 0;  // N, N m: what is to be told from round-off
  for (std::size_t k = 0; k < steps.extremes.size(); ++k) {
    if (is_wall(k)) continue;
    double arm = 0;
    for (const Place& place : model_.interfaces[k].position) arm = std::max(arm, (place - model_.interfaces[k].reference).norm());
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const StepRecord::Instant& now = steps.at(i, k);
      note(result_.max_base_moment, plane ? now.moment_1 : std::hypot(now.moment_1, now.moment_2), steps.time[i]);
      note(result_.max_base_shear, plane ? now.shear_1 : std::hypot(now.shear_1, now.shear_2), steps.time[i]);
      const double size = std::hypot(now.axial, now.shear_1, now.shear_2);
      force = std::max(force, size), moment = std::max(moment, arm * size);
    }
    note(result_.max_pressure, steps.extremes[k].max_pressure.value, steps.extremes[k].max_pressure.time);
  }
  constexpr double round_off = 1e-9, least = 1e-9;  // share of it; N, N m
  if (std::abs(result_.max_base_shear.value) < std::max(round_off * force, least))
    result_.max_base_shear.value = result_.max_base_shear.time = 0;
  if (std::abs(result_.max_base_moment.value) < std::max(round_off * moment, least))
    result_.max_base_moment.value = result_.max_base_moment.time = 0;
}

bool BaseWatch::moves_little(const State& state, const Model& model, const std::vector<int>& rotations, std::optional<double> share) {
  for (int unknown : rotations)
    if (std::abs(state.displacement[unknown]) > plan_.rotation_limit) {
      end(RunStatus::overturned, fmt::format("{} passed {:.3g} rad", model.unknown_name(unknown), plan_.rotation_limit), state, share);
      return false;
    }
  return (!rotations.empty() || surfaces_turn_little(state, share)) &&
         (plan_.separation_limit <= 0 || farthest_ <= plan_.separation_limit || surfaces_stay_near(state, share));
}

[[gnu::cold]] void BaseWatch::end(RunStatus status, const std::string& what, const State& state, std::optional<double> share) {
  const std::string when = share ? fmt::format("{:.4g} % of the static load", 100 * *share) : fmt::format("t = {:.6g} s", state.time);
  result_.status = status;
  result_.reason = fmt::format("{} at {}, the limit of the small-displacement model", what, when);
}

/// Nodes of solids do not turn: there the slope of the opening's best plane is what the building has turned against the soil.
bool BaseWatch::surfaces_turn_little(const State& state, std::optional<double> share) {
  for (std::size_t k = 0; k < model_.interfaces.size(); ++k) {
    if (is_wall(k)) continue;
    const std::array<double, 2>& slope = views_[k].rotation;
    if (!(std::hypot(slope[0], slope[1]) > plan_.rotation_limit)) continue;
    end(RunStatus::overturned,
        fmt::format("'{}' passed a slope of {:.3g} rad between its sides", model_.interfaces[k].name, plan_.rotation_limit), state, share);
    return false;
  }
  return true;
}

/// A body may also leave the ground without turning.
bool BaseWatch::surfaces_stay_near(const State& state, std::optional<double> share) {
  for (std::size_t k = 0; k < model_.interfaces.size(); ++k) {
    const Interface& interface = model_.interfaces[k];
    if (is_wall(k)) continue;
    if (!(views_[k].least_opening > plan_.separation_limit)) continue;
    if (!(views_[k].least_opening - interface.gap.maxCoeff() > plan_.separation_limit)) continue;
    end(RunStatus::separated, fmt::format("'{}' is open everywhere by more than {:.3g} m", interface.name, plan_.separation_limit), state,
        share);
    return false;
  }
  return true;
}

}  // namespace uplift
