#include "uplift/analysis/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "uplift/analysis/buckling.h"
#include "uplift/analysis/probe.h"
#include "uplift/analysis/runner.h"
#include "uplift/dynamics/plastic_bulk.h"
#include "uplift/dynamics/statics.h"
#include "uplift/model/geometric.h"

namespace uplift {

std::string_view to_string(RunStatus status) {
  switch (status) {
    case RunStatus::completed:
      return "completed";
    case RunStatus::overturned:
      return "overturned";
    case RunStatus::separated:
      return "separated";
    case RunStatus::failed:
      return "failed";
    case RunStatus::interrupted:
      return "interrupted";
  }
  return "";
}

const Stage* dynamic_stage(const RunPlan& plan) {
  for (const Stage& stage : plan.stages)
    if (stage.type == Stage::Type::dynamics) return &stage;
  return nullptr;
}

bool statics_alone(const RunPlan& plan) {
  return !plan.stages.empty() && dynamic_stage(plan) == nullptr;
}

bool is_step_mean(Request::Kind kind) {
  using enum Request::Kind;
  switch (kind) {
    case acceleration:
    case absolute_acceleration:
    case traction:
    case axial:
    case shear:
    case moment:
    case shear_1:
    case shear_2:
    case moment_1:
    case moment_2:
    case torsion:
    case max_pressure:
      return true;
    default:
      return false;
  }
}

std::string RunResult::created_percent() const {
  return energy_scale > 0 ? fmt::format("{:.3g} %", 100 * energy_created / energy_scale) : "0 %";
}

namespace {

Vector stack_gaps(const Model& model) {
  Vector gap(model.rows());
  int first = 0;
  for (const Interface& interface : model.interfaces) {
    gap.segment(first, interface.rows()) = interface.gap;
    first += interface.rows();
  }
  return gap;
}

}  // namespace

Runner::Runner(const Model& model, const RunPlan& plan, const std::vector<const Values*>& behaviours, const Watch& watch,
               const Observe& observe)
    : model_(model),
      plan_(plan),
      parameters_(behaviours),
      watch_(watch),
      observe_(observe),
      b_(stack_interfaces(model)),
      gap_(stack_gaps(model)),
      viewer_(model, plan.gap_tolerance, plan.bases, plan.facets),
      rest_(plan.rest.get()),
      views_(model.interfaces.size()) {
  has_walls_ = std::ranges::any_of(plan.is_wall, [](char wall) { return wall != 0; });
  result_.name = plan.name;
  result_.label = plan.label;
  result_.group = plan.group;
  result_.expected_to_fail = plan.expected_to_fail;
  result_.max_uplifted_ratio = {"max_uplifted_ratio", "1", 0, 0};
  result_.max_opening = {"max_opening", "m", 0, 0};
  result_.max_base_moment = {"max_base_moment", "N m", 0, 0};
  result_.max_base_shear = {"max_base_shear", "N", 0, 0};
  result_.max_pressure = {"max_pressure", "Pa", 0, 0};
}

RunResult Runner::go() {
  const auto start = std::chrono::steady_clock::now();
  execute();
  result_.steps.average(plan_.window);
  take_window_peaks();
  result_.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() - shown_;
  result_.counts.factorisations = linear_.factorisations;
  if (!linear_.notice.empty()) result_.notes.push_back(linear_.notice);
  result_.counts.back_solves = linear_.back_solves;
  result_.counts.systems = linear_.systems;
  return std::move(result_);
}

/// Largest forces of the bases as means over the window, which the verdict shows.
void Runner::take_window_peaks() {
  const StepRecord& steps = result_.steps;
  result_.max_step_pressure = result_.max_pressure;
  for (Peak* peak : {&result_.max_base_moment, &result_.max_base_shear, &result_.max_pressure}) peak->value = peak->time = 0;
  const auto note = [](Peak& peak, double value, double time) {
    if (std::abs(value) > std::abs(peak.value)) peak.value = value, peak.time = time;
  };
  const bool plane = model_.space.dimension == 2;
  for (std::size_t k = 0; k < steps.extremes.size(); ++k) {
    if (is_wall(k)) continue;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const StepRecord::Instant& now = steps.at(i, k);
      note(result_.max_base_moment, plane ? now.moment_1 : std::hypot(now.moment_1, now.moment_2), steps.time[i]);
      note(result_.max_base_shear, plane ? now.shear_1 : std::hypot(now.shear_1, now.shear_2), steps.time[i]);
    }
    note(result_.max_pressure, steps.extremes[k].max_pressure.value, steps.extremes[k].max_pressure.time);
  }
}

void Runner::fail(std::string why, const InterfaceProblem* problem) {
  result_.status = RunStatus::failed;
  result_.reason = std::move(why);
  result_.end_time = seen_->time;
  if (problem != nullptr && problem->rows() > 0) result_.problem = save_problem(*problem, parameters_, result_.reason);
}

void Runner::execute() {
  const Stage* dynamic = dynamic_stage(plan_);
  InterfaceProblem compliance;
  bool cones = false;
  for (const Interface& interface : model_.interfaces) cones = cones || interface.cone != nullptr;
  if (dynamic != nullptr && cones && !plan_.method->constrains()) {
    std::string why;
    compliance = probe(model_, Bulk(model_, nullptr), b_, *dynamic, *plan_.solver, linear_, why);
    if (!why.empty()) return fail(why, nullptr);
  }
  laws_ = std::make_unique<Behaviours>(model_, *plan_.method, compliance.rows() > 0 ? &compliance : nullptr);
  laws_->solver = plan_.interface_solver;

  const Eigen::Index n = rest_ != nullptr ? rest_->free() : model_.free();
  state_.displacement = state_.velocity = state_.acceleration = Vector::Zero(n);
  start_gap_ = gap_;
  for (const PrescribedMotion& motion : model_.motions)
    if (motion.opening.size() > 0) start_gap_ += motion.opening * motion.function->value(0);
  state_.opening = start_gap_;
  state_.force = state_.mean_force = Vector::Zero(b_.rows());
  state_.history.setZero(laws_->history);
  remember_gaps();
  for (int column = 0; column < b_.outerSize(); ++column) {
    const int unknown = model_.kept[static_cast<std::size_t>(column)];
    if (Sparse::InnerIterator(b_, column) && model_.space.is_rotation(unknown)) rotations_.push_back(column);
  }

  for (const Stage& stage : plan_.stages) planned_ += stage.type == Stage::Type::dynamics ? stage.duration : 0;
  if (dynamic != nullptr) tail_ = 0.1 * planned_ + 0.5 * dynamic->step;

  bool moving = false;
  for (const Stage& stage : plan_.stages) {
    if (stage.type == Stage::Type::statics) {
      march_.reset();
      if (!statics(stage, nullptr)) return;
      show(stage, nullptr, stage.steps, true);
      continue;
    }
    if (stage.p_delta && geometric_ == nullptr && !second_order()) return;
    if (rest_ != nullptr) release();
    if (!std::exchange(moving, true)) {
      if (&stage != plan_.stages.data()) note_rest();
      add_initial_state();
    }
    const Bulk stage_bulk(model_, geometric_.get());
    if (!dynamics(stage, stage_bulk)) return;
  }
  result_.end_time = state_.time;
  if (statics_alone(plan_)) stand();
}

/// A joint with an initial gap was broken before the analysis: its law remembers an opening from zero to that gap (the SDM's jump is the
/// gap), or the first step would take the gap for a stretched joint.
void Runner::remember_gaps() {
  const InterfaceProblem blocks = blocks_of(model_, *laws_);
  for (const Block& block : blocks.blocks) {
    const Vector gap = gap_.segment(block.first, block.rows()).cwiseMax(0), closed = Vector::Zero(block.rows());
    if (block.law == nullptr || block.law->num_history(block.batch.components) == 0 || gap.isZero(0)) continue;
    Vector traction(block.rows());
    Reply reply;
    reply.traction = traction.data();
    reply.now = state_.history.data() + block.first_history;
    block.law->respond(block.batch, closed.data(), gap.data(), blocks.old.data() + block.first_history, reply);
  }
}

/// What the verdict holds the rest of the run against.
void Runner::note_rest() {
  viewer_.look(state_.opening, state_.mean_force, views_);
  for (std::size_t k = 0; k < views_.size(); ++k) {
    result_.steps.rest.push_back(views_[k].resultant);
    result_.steps.rest_poses.push_back(viewer_.pose(state_, k, views_[k]));
  }
}

/// Static stages alone: how the structure stands at their end is the result, one row of it. What the verdict calls left is then measured
/// from the unloaded structure.
void Runner::stand() {
  if (rest_ != nullptr) state_ = carried();
  Energies& energies = result_.final_energy;
  energies.strain = 0.5 * state_.displacement.dot(model_.stiffness * state_.displacement);
  if (const PlasticBulk yielding(model_); yielding.any())
    energies.strain += yielding.energy(state_.displacement, state_.time, yielding.state(state_.bulk_history));
  InterfaceEnergy held;
  held.update(blocks_of(model_, *laws_), state_.opening, state_.history);
  energies.stored = held.stored, energies.interface_dissipated = held.dissipated;
  PageTaker pages;  // none
  result_.steps.reserve(model_.interfaces.size(), 1, 1, pages);
  viewer_.look(state_.opening, state_.mean_force, views_);
  note_views();
  sum_up(0);
  for (const InterfaceView& view : views_) result_.steps.rest.push_back(view.resultant);
  Recorder recorder(model_, plan_, state_, energies, nullptr, views_, {model_}, 0, 0, pages, result_);
  recorder.record(true);
  recorder.finish();
  const Vector still = Vector::Zero(model_.free());
  EquilibriumCheck equilibrium(ForceStage{model_});
  equilibrium.note(StepBalance::of_state(state_, still));
  equilibrium.finish(result_.equilibrium);
  if (plan_.frames > 0) recorder.picture(state_);
}

/// The initial state of the first dynamic stage comes on top of what the static stages left: laws answer the change of the openings, a
/// constraint that is opened by it has no force any more.
void Runner::add_initial_state() {
  const Eigen::Index n = model_.free();
  if (plan_.initial_velocity.size() == n) state_.velocity += plan_.initial_velocity;
  if (plan_.initial_displacement.size() != n || plan_.initial_displacement.isZero(0)) return;
  state_.displacement += plan_.initial_displacement;
  const Vector from = state_.opening;
  state_.opening += b_ * plan_.initial_displacement;
  const Vector old = state_.history;
  for (const Block& block : blocks_of(model_, *laws_).blocks) {
    const int points = block.batch.points, normal = block.first + block.batch.normal();
    if (block.law != nullptr) {
      Reply reply;
      reply.traction = state_.force.data() + block.first;
      reply.now = state_.history.data() + block.first_history;
      block.law->respond(block.batch, from.data() + block.first, state_.opening.data() + block.first, old.data() + block.first_history,
                         reply);
    }
    for (int c = 0; c < block.batch.components; ++c)
      for (int i = 0; i < points; ++i) {
        double& force = state_.force[block.first + c * points + i];
        if (block.law != nullptr)
          force *= block.area[static_cast<std::size_t>(i)];
        else if (state_.opening[normal + i] > 0)
          force = 0;
      }
  }
  state_.mean_force = state_.force;
}

/// The geometric stiffness of the present static state, and equilibrium with it.
bool Runner::second_order() {
  const Model& resting = rest_ != nullptr ? *rest_ : model_;
  second_order_ = uplift::second_order(resting, state_);
  geometric_ = std::make_unique<Sparse>(model_.reduction.transpose() * second_order_.stiffness * model_.reduction);
  if (const auto share = buckling_share(model_, *geometric_, *plan_.solver)) {
    fail(fmt::format("P-delta: the structure buckles under {:.4g} times its dead loads: with the whole of them K + K_g is not positive "
                     "definite, even with all interfaces bonded",
                     *share),
         nullptr);
    return false;
  }
  for (const PrescribedMotion& motion : model_.motions)
    if (Vector force = -(model_.reduction.transpose() * (second_order_.stiffness * motion.shape)); !force.isZero(0))
      second_order_drives_.push_back({motion.name, std::move(force), motion.function});
  if (state_.displacement.isZero(0)) return true;
  Stage again;
  again.type = Stage::Type::statics;
  if (rest_ == nullptr) return statics(again, geometric_.get());
  const Sparse geometric = resting.reduction.transpose() * second_order_.stiffness * resting.reduction;
  return statics(again, &geometric);
}

/// The state of the model with all supports on the free unknowns of the one without those of static stages alone: the same displacements.
State Runner::carried() const {
  State state = state_;
  const Vector full = rest_->full(state_.displacement, 0, state_.time);
  const Eigen::Index n = model_.free();
  state.displacement.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) state.displacement[i] = full[model_.kept[static_cast<std::size_t>(i)]];
  state.velocity = state.acceleration = Vector::Zero(n);
  return state;
}

/// Goes over to the model without these supports. What is missing for equilibrium, r = K u + B^T p - f, is what they have borne; from now
/// on it is a constant load, so that nothing moves when nothing shakes (docs/theory, eq 22).
void Runner::release() {
  state_ = carried();
  held_ = model_.stiffness * state_.displacement;
  if (geometric_ != nullptr) held_ += *geometric_ * state_.displacement;
  if (const PlasticBulk yielding(model_); yielding.any()) held_ += yielding.state(state_.bulk_history).force;
  if (b_.rows() > 0) held_ += b_.transpose() * state_.force;
  for (const Drive& drive : model_.drives)
    if (drive.dead) held_ -= drive.factor(state_.time) * drive.shape;
  rest_ = nullptr;
}

bool Runner::statics(const Stage& stage, const Sparse* geometric) {
  const Model& resting = rest_ != nullptr ? *rest_ : model_;
  const Sparse b = rest_ != nullptr ? stack_interfaces(*rest_) : b_;
  const Bulk bulk(resting, geometric);
  const StaticOutcome outcome =
      solve_statics(resting, bulk, b, start_gap_, *laws_, *plan_.method, *plan_.solver, stage.steps, state_, linear_);
  result_.counts.retries += outcome.retries;
  result_.counts.iterations += outcome.iterations;
  if (!outcome.converged) {
    fail(outcome.why, outcome.failed ? &*outcome.failed : nullptr);
    return false;
  }
  return true;
}

ForceStage Runner::force_stage(const Stage& stage) const {
  return {model_, stage.p_delta ? &second_order_ : nullptr, held_.size() > 0 ? &held_ : nullptr};
}

/// Tells the observer, if there is one, of the present state. Its time is not that of the run.
void Runner::show(const Stage& stage, const Stepper* stepper, long step, bool last) {
  if (!observe_) return;
  sum_up(stage.step);
  const auto start = std::chrono::steady_clock::now();
  std::optional<State> resting;
  if (rest_ != nullptr) resting = carried();
  observe_({resting ? *resting : *seen_, stepper, result_, static_cast<std::size_t>(&stage - plan_.stages.data()), step, last});
  shown_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

RunResult run(const Model& model, const RunPlan& plan, const std::vector<const Values*>& behaviours, const Watch& watch,
              const Observe& observe) {
  return Runner(model, plan, behaviours, watch, observe).go();
}

}  // namespace uplift
