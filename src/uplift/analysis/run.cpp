#include "uplift/analysis/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "uplift/analysis/record.h"
#include "uplift/dynamics/plastic_bulk.h"
#include "uplift/dynamics/split_response.h"
#include "uplift/dynamics/statics.h"
#include "uplift/dynamics/step.h"
#include "uplift/model/geometric.h"

namespace uplift {

std::string_view to_string(RunStatus status) {
  switch (status) {
    case RunStatus::completed:
      return "completed";
    case RunStatus::overturned:
      return "overturned";
    case RunStatus::failed:
      return "failed";
    case RunStatus::interrupted:
      return "interrupted";
  }
  return "";
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

/// Compliance of the interfaces at a dynamic step, for automatic stiffnesses and for `check`.
InterfaceProblem probe(const Model& model, const Bulk& bulk, const Sparse& b, const Stage& stage, const LinearSolver& solver,
                       LinearCounts& counts, std::string& why) {
  const Scheme& s = stage.scheme;
  const double w = 1 - s.alpha_f, dt = stage.step;
  const Sparse matrix =
      bulk.stiffness_matrix + s.gamma / (s.beta * dt) * bulk.damping_matrix + (1 - s.alpha_m) / (w * s.beta * dt * dt) * bulk.mass_matrix;
  struct None final : ContactMethod {
    Outcome solve(const InterfaceProblem&, InterfaceSolution&) const override { return {}; }
    bool constrains() const override { return false; }
  };
  const None none;
  InterfaceProblem problem = blocks_of(model, Behaviours(model, none, nullptr));
  problem.step = dt;
  BulkFactor factor(matrix, &b, bulk.small, solver, model, counts);
  if (!factor.ok()) {
    why = factor.why();
    return problem;
  }
  problem.factor = factor.split() != nullptr ? SplitResponse(factor, b).factor() : factor.spread(b).factor;
  return problem;
}

/// One run: the state, what is watched, what is written.
class Runner {
 public:
  Runner(const Model& model, const RunPlan& plan, const std::vector<const Values*>& behaviours, const Watch& watch, const Observe& observe)
      : model_(model),
        plan_(plan),
        parameters_(behaviours),
        watch_(watch),
        observe_(observe),
        b_(stack_interfaces(model)),
        gap_(stack_gaps(model)),
        viewer_(model, plan.gap_tolerance),
        rest_(plan.rest.get()) {
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

  RunResult go() {
    const auto start = std::chrono::steady_clock::now();
    execute();
    result_.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() - shown_;
    result_.counts.factorisations = linear_.factorisations;
    if (!linear_.notice.empty()) result_.notes.push_back(linear_.notice);
    result_.counts.back_solves = linear_.back_solves;
    return std::move(result_);
  }

 private:
  void execute();
  void remember_gaps();
  void initial_forces();
  void add_initial_state();
  bool statics(const Stage& stage, const Sparse* geometric);
  bool second_order();
  State carried() const;
  void release();
  bool dynamics(const Stage& stage, const Bulk& bulk);
  void show(const Stage& stage, const Stepper* stepper, long step, bool last);
  void note_views(double step);
  bool check_limits(const Stepper& stepper);
  void finish_energy(const Stepper& stepper);
  void fail(std::string why, const InterfaceProblem* problem);

  const Model& model_;
  const RunPlan& plan_;
  const std::vector<const Values*>& parameters_;
  const Watch& watch_;
  const Observe& observe_;
  const Sparse b_;
  const Vector gap_;
  Vector start_gap_;  // with the prescribed motions at time 0
  InterfaceViewer viewer_;
  RunResult result_;
  LinearCounts linear_;
  std::unique_ptr<Behaviours> laws_;
  std::unique_ptr<Sparse> geometric_;
  const Model* rest_;            // the static stages' model before the first dynamic stage; null: model_
  Vector held_;                  // what released supports have borne, on the free unknowns [N, N m]
  State state_;                  // between stages
  const State* seen_ = &state_;  // the present one, wherever it lives
  std::vector<InterfaceView> views_;
  std::vector<int> rotations_;    // free unknowns that are rotations of bodies on an interface
  double initial_scale_ = 0;      // J
  std::optional<Ledger> ledger_;  // of the dynamic stage before
  std::optional<Stage> march_;    // that stage, as long as nothing came in between
  double round_off_energy_ = 0;   // J: less than this is nothing
  double shown_ = 0;              // s: taken by the observer
};

void Runner::fail(std::string why, const InterfaceProblem* problem) {
  result_.status = RunStatus::failed;
  result_.reason = std::move(why);
  result_.end_time = seen_->time;
  if (problem != nullptr && problem->rows() > 0) result_.problem = save_problem(*problem, parameters_, result_.reason);
}

void Runner::execute() {
  const Stage* dynamic = nullptr;
  for (const Stage& stage : plan_.stages)
    if (dynamic == nullptr && stage.type == Stage::Type::dynamics) dynamic = &stage;
  InterfaceProblem compliance;
  bool cones = false;
  for (const Interface& interface : model_.interfaces) cones = cones || interface.cone != nullptr;
  if (dynamic != nullptr && cones && !plan_.method->constrains()) {
    std::string why;
    compliance = probe(model_, Bulk(model_, nullptr), b_, *dynamic, *plan_.solver, linear_, why);
    if (!why.empty()) return fail(why, nullptr);
  }
  laws_ = std::make_unique<Behaviours>(model_, *plan_.method, compliance.rows() > 0 ? &compliance : nullptr);

  const Eigen::Index n = rest_ != nullptr ? rest_->free() : model_.free();
  state_.displacement = state_.velocity = state_.acceleration = Vector::Zero(n);
  start_gap_ = gap_;
  for (const PrescribedMotion& motion : model_.motions)
    if (motion.opening.size() > 0) start_gap_ += motion.opening * motion.function->value(0);
  state_.opening = start_gap_;
  state_.force = state_.mean_force = Vector::Zero(b_.rows());
  state_.history.assign(static_cast<std::size_t>(laws_->history), 0.0);
  remember_gaps();
  initial_forces();
  for (int column = 0; column < b_.outerSize(); ++column) {
    const int unknown = model_.kept[static_cast<std::size_t>(column)];
    if (Sparse::InnerIterator(b_, column) && model_.space.is_rotation(unknown)) rotations_.push_back(column);
  }

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
    if (!std::exchange(moving, true)) add_initial_state();
    const Bulk stage_bulk(model_, geometric_.get());
    if (!dynamics(stage, stage_bulk)) return;
  }
  result_.end_time = state_.time;
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

/// The initial state of the first dynamic stage comes on top of what the static stages left: laws answer the change of the openings, a
/// constraint that is opened by it has no force any more.
void Runner::add_initial_state() {
  const Eigen::Index n = model_.free();
  if (plan_.initial_velocity.size() == n) state_.velocity += plan_.initial_velocity;
  if (plan_.initial_displacement.size() != n || plan_.initial_displacement.isZero(0)) return;
  state_.displacement += plan_.initial_displacement;
  const Vector from = state_.opening;
  state_.opening += b_ * plan_.initial_displacement;
  const std::vector<double> old = state_.history;
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

/// Forces and memory of the laws under an initial displacement, reached from rest.
void Runner::initial_forces() {
  if (state_.displacement.isZero(0)) return;
  const InterfaceProblem blocks = blocks_of(model_, *laws_);
  const std::vector<double> old = state_.history;
  for (const Block& block : blocks.blocks) {
    if (block.law == nullptr) continue;
    Reply reply;
    reply.traction = state_.force.data() + block.first;
    reply.now = state_.history.data() + block.first_history;
    block.law->respond(block.batch, start_gap_.data() + block.first, state_.opening.data() + block.first, old.data() + block.first_history,
                       reply);
    for (int i = 0; i < block.rows(); ++i) reply.traction[i] *= block.area[static_cast<std::size_t>(i % block.batch.points)];
  }
  state_.mean_force = state_.force;
}

/// The geometric stiffness of the present static state, and equilibrium with it.
bool Runner::second_order() {
  const Model& resting = rest_ != nullptr ? *rest_ : model_;
  geometric_ = std::make_unique<Sparse>(geometric_stiffness(resting, state_, model_.reduction));
  if (state_.displacement.isZero(0)) return true;
  Stage again;
  again.type = Stage::Type::statics;
  if (rest_ == nullptr) return statics(again, geometric_.get());
  const Sparse geometric = geometric_stiffness(resting, state_);
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
    fail(outcome.why, nullptr);
    return false;
  }
  return true;
}

/// Tells the observer, if there is one, of the present state. Its time is not that of the run.
void Runner::show(const Stage& stage, const Stepper* stepper, long step, bool last) {
  if (!observe_) return;
  const auto start = std::chrono::steady_clock::now();
  std::optional<State> resting;
  if (rest_ != nullptr) resting = carried();
  observe_({resting ? *resting : *seen_, stepper, result_, static_cast<std::size_t>(&stage - plan_.stages.data()), step, last});
  shown_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Runner::note_views(double step) {
  bool open = false, any_contact = views_.empty();
  for (const InterfaceView& view : views_) {
    const double time = seen_->time;
    const auto note = [time](Peak& peak, double value) {
      if (std::abs(value) > std::abs(peak.value)) peak.value = value, peak.time = time;
    };
    note(result_.max_uplifted_ratio, view.open_area);
    note(result_.max_opening, view.max_opening);
    note(result_.max_base_moment, view.resultant.moment);
    note(result_.max_base_shear, view.resultant.shear);
    note(result_.max_pressure, view.max_pressure);
    result_.max_penetration = std::max(result_.max_penetration, -view.least_opening);
    open = open || view.open_area > 0;
    any_contact = any_contact || view.open_area < 1;
  }
  if (open) {
    if (result_.first_uplift < 0) result_.first_uplift = seen_->time;
    result_.time_uplifted += step;
  }
  if (!any_contact) result_.full_loss += step;
}

/// Energy created and lost so far; the scale is the largest external work, or the energy at the beginning where no load works. Work of the
/// dead loads over 1e-10 m, and 1e-8 of the energy that the static state stores (of which the gate takes a hundredth), are round-off: a
/// structure that only stands there has created nothing.
void Runner::finish_energy(const Stepper& stepper) {
  const Energies& energies = stepper.energies();
  const double created = energies.residual + std::max(0.0, -energies.impact);
  if (created > result_.energy_created) result_.energy_created = created, result_.energy_created_time = seen_->time;
  if (-energies.residual > result_.energy_lost) result_.energy_lost = -energies.residual, result_.energy_lost_time = seen_->time;
  result_.energy_scale = std::max(stepper.largest_external(), initial_scale_);
  if (result_.energy_scale <= 0) result_.energy_scale = stepper.initial_energy();
  result_.energy_scale = std::max(result_.energy_scale, round_off_energy_);
}

/// False when the run ends here: not finite, far beyond the energy limit, or rotated beyond the small-displacement model.
bool Runner::check_limits(const Stepper& stepper) {
  const Energies& energies = stepper.energies();
  if (!std::isfinite(energies.residual) || !std::isfinite(energies.kinetic)) {
    fail(fmt::format("the energy is not finite at t = {:.6g} s", seen_->time), stepper.problem());
    return false;
  }
  const bool creates = result_.energy_scale > 0 && result_.energy_created > plan_.created_limit * result_.energy_scale;
  if (creates && (plan_.stop_at_limit || result_.energy_created > 1e6 * result_.energy_scale)) return false;
  if (creates) return true;
  for (int unknown : rotations_)
    if (std::abs(seen_->displacement[unknown]) > plan_.rotation_limit) {
      result_.status = RunStatus::overturned;
      result_.reason = fmt::format("{} passed {:.3g} rad at t = {:.6g} s, the limit of the small-displacement model",
                                   model_.unknown_names[static_cast<std::size_t>(unknown)], plan_.rotation_limit, seen_->time);
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
  if (ledger_ && !(march_ && march_->p_delta == stage.p_delta && march_->scheme == stage.scheme)) ledger_->acceleration = false;
  Stepper stepper(model_, bulk, b_, gap_, *laws_, *plan_.method, *plan_.impact, *plan_.solver, options, linear_);
  stepper.start(std::move(state_), ledger_ ? &*ledger_ : nullptr);
  seen_ = &stepper.state();
  const long steps = std::max(1L, std::lround(stage.duration / stage.step));
  const std::size_t rows = static_cast<std::size_t>(steps / plan_.every) + 2;
  Recorder recorder(model_, plan_, viewer_, rows, result_);
  const long picture_every = plan_.frames > 0 ? std::max(1L, steps / plan_.frames) : 0;
  if (!ledger_) initial_scale_ = stepper.energies().kinetic;
  if (!ledger_) round_off_energy_ = 1e-8 * (stepper.energies().strain + stepper.energies().stored);
  for (const Drive& drive : model_.drives)
    if (drive.dead) round_off_energy_ += 1e-10 * drive.shape.lpNorm<1>() * std::abs(drive.function->value(seen_->time));
  const auto observe = [&](long step) {
    viewer_.look(seen_->opening, seen_->force, views_);
    note_views(step == 0 ? 0 : stage.step);
    recorder.record(stepper, views_, step % plan_.every == 0 || step == steps);
    if (picture_every > 0 && step % picture_every == 0) recorder.picture(*seen_);
  };
  if (!ledger_) {  // else the end of the stage before is there already
    observe(0);
    show(stage, &stepper, 0, false);
  }
  bool go_on = true;
  const long between = bulk.small ? 256 : 8;  // steps from one report of progress to the next
  auto first_done = std::chrono::steady_clock::now();
  double shown_before = shown_;
  for (long step = 1; step <= steps && go_on; ++step) {
    if (!stepper.advance()) {
      fail(fmt::format("step at t = {:.6g} s failed down to dt = {:.3g} s: {}", seen_->time, stage.step / std::pow(2, stage.halvings),
                       stepper.why()),
           stepper.problem());
      show(stage, &stepper, step - 1, true);
      break;
    }
    finish_energy(stepper);
    observe(step);
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

}  // namespace

RunResult run(const Model& model, const RunPlan& plan, const std::vector<const Values*>& behaviours, const Watch& watch,
              const Observe& observe) {
  return Runner(model, plan, behaviours, watch, observe).go();
}

std::vector<StiffnessRatio> stiffness_ratios(const Model& model, const Stage& stage, const LinearSolver& solver) {
  const Bulk bulk(model, nullptr);
  LinearCounts counts;
  std::string why;
  const InterfaceProblem problem = probe(model, bulk, stack_interfaces(model), stage, solver, counts, why);
  std::vector<StiffnessRatio> ratios;
  if (!why.empty()) return ratios;
  for (std::size_t k = 0; k < problem.blocks.size(); ++k) {
    const Block& block = problem.blocks[k];
    StiffnessRatio ratio{block.name, 1e300, 0, 0};
    double stiffness[3] = {0, 0, 0};
    if (block.law != nullptr) block.law->closed_stiffness(block.batch.components, stiffness);
    for (int i = 0; i < block.batch.points; ++i) {
      const double compliance = problem.factor.row(block.first + block.batch.normal() + i).squaredNorm();
      const double value = stiffness[block.batch.components - 1] * block.area[static_cast<std::size_t>(i)] * compliance;
      ratio.least = std::min(ratio.least, value);
      ratio.most = std::max(ratio.most, value);
      ratio.compliance = std::max(ratio.compliance, compliance);
    }
    ratios.push_back(ratio);
  }
  return ratios;
}

}  // namespace uplift
