#include "uplift/run/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "uplift/model/numbering.h"
#include "uplift/run/probe.h"
#include "uplift/run/runner.h"

namespace uplift {

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
               const Observe& observe, const Keeping& keeping)
    : model_(model),
      plan_(plan),
      parameters_(behaviours),
      watch_(watch),
      observe_(observe),
      keeping_(keeping),
      b_(stack_interfaces(model)),
      gap_(stack_gaps(model)),
      rotations_(rotations_on_interfaces(model, b_)),
      bases_(model, plan, b_, run_.result),
      rest_(plan.rest.get()) {
  run_.result.name = plan.name;
  run_.result.label = plan.label;
  run_.result.group = plan.group;
  run_.result.expected_to_fail = plan.expected_to_fail;
}

RunResult Runner::go() {
  const auto start = std::chrono::steady_clock::now();
  execute();
  check_tables();
  bases_.finish();
  run_.result.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() - shown_;
  run_.result.counts.factorisations = run_.linear.factorisations;
  if (!run_.linear.notice.empty()) run_.result.notes.push_back(run_.linear.notice);
  if (!run_.linear.remark.empty()) run_.result.notes.push_back("solver: " + run_.linear.remark);
  run_.result.solver = run_.linear.remark;
  run_.result.counts.back_solves = run_.linear.back_solves;
  run_.result.counts.systems = run_.linear.systems;
  return std::move(run_.result);
}

/// A run with a number in its tables that is not finite has failed, also where its energies are finite.
void Runner::check_tables() {
  for (const std::vector<std::vector<double>>* table : {&run_.result.table, &run_.result.load_steps})
    for (std::size_t k = 1; k < table->size(); ++k) {
      const std::vector<double>& column = (*table)[k];
      if (std::isfinite(ConstMap(column.data(), std::ssize(column)).sum())) continue;  // finds them fast, and a few sums too large
      const auto bad = std::ranges::find_if_not(column, [](double value) { return std::isfinite(value); });
      if (bad == column.end() || run_.result.status == RunStatus::failed) continue;
      run_.result.status = RunStatus::failed;
      const double at = table->front()[static_cast<std::size_t>(bad - column.begin())];
      const bool over_time = table == &run_.result.table && !statics_alone(plan_);
      run_.result.reason = fmt::format("{} is not finite at {}", plan_.requests[k - 1].name,
                                       over_time ? fmt::format("t = {:.6g} s", at) : fmt::format("the load factor {:.6g}", at));
    }
}

void Runner::fail(std::string why, const InterfaceProblem* problem) {
  run_.result.status = RunStatus::failed;
  run_.result.reason = std::move(why);
  run_.result.end_time = seen_->time;
  if (problem != nullptr && problem->rows() > 0) run_.result.problem = save_problem(*problem, parameters_, run_.result.reason);
}

void Runner::execute() {
  const Stage* dynamic = dynamic_stage(plan_);
  ContactModel compliance;
  bool cones = false;
  for (const Interface& interface : model_.interfaces) cones = cones || interface.cone != nullptr;
  if (cones && !plan_.method->constrains()) {
    std::string why;
    compliance = dynamic != nullptr
                     ? probe(model_, Bulk(plan_.solver->matrices_of(model_), nullptr), b_, *dynamic, *plan_.solver, run_.linear, why)
                     : static_probe(rest_ != nullptr ? *rest_ : model_, *plan_.solver, run_.linear, why);
    if (!why.empty()) return fail(dynamic != nullptr ? why : "static stage: " + why, nullptr);
  }
  laws_ = std::make_unique<Behaviours>(model_, *plan_.method, compliance.rows() > 0 ? &compliance : nullptr);
  laws_->solver = plan_.interface_solver;

  if (keeping_.from == nullptr)
    begin();
  else if (!resume())
    return fail("the state that the run begins with belongs to another model", nullptr);
  run_stages();
  run_.result.end_time = run_.state.time;
  if (statics_alone(plan_))
    stand();
  else
    run_.result.load_steps = std::move(run_.load_steps.table);
}

void Runner::begin() {
  const Eigen::Index n = rest_ != nullptr ? rest_->free() : model_.free();
  run_.state.displacement = run_.state.velocity = run_.state.acceleration = Vector::Zero(n);
  if (!plan_.stages.empty() && plan_.stages.front().type == Stage::Type::statics) run_.state.load_factor = 0;
  run_.state.opening = gap_;
  if (run_.state.load_factor > 0) model_.add_prescribed_opening(0, run_.state.opening);
  run_.state.force = run_.state.mean_force = Vector::Zero(b_.rows());
  run_.state.history.setZero(laws_->history);
  remember_gaps();
}

/// Takes over a kept state; false when it does not fit the model or the plan.
bool Runner::resume() {
  const RunState& from = *keeping_.from;
  const State& state = from.step > 0 ? from.march.state : from.state;
  if (from.stage >= plan_.stages.size() || plan_.stages[from.stage].type != Stage::Type::dynamics || from.step < 0 ||
      state.displacement.size() != model_.free() || state.opening.size() != b_.rows() || state.history.size() != laws_->history)
    return false;
  if (from.step > 0 && (from.result.table.size() != plan_.requests.size() + 1 || from.result.combined.size() != plan_.combined.size() ||
                        from.result.floors.size() != plan_.floors.size() || from.result.envelopes.size() != plan_.envelopes.size() ||
                        from.result.steps.extremes.size() != model_.interfaces.size()))
    return false;
  run_ = from;
  if (const std::vector<int> number = numbers_by_nodes(model_); !number.empty()) renumber(inverse(number), run_);
  run_.result.columns = plan_.requests;
  bases_.resume();
  rest_ = nullptr;  // of static stages before
  if (run_.second_order) use_second_order();
  return true;
}

/// Ends at the first stage that fails or ends the run.
void Runner::run_stages() {
  for (; run_.stage < plan_.stages.size(); ++run_.stage, run_.step = 0) {
    const Stage& stage = plan_.stages[run_.stage];
    if (stage.type == Stage::Type::statics) {
      run_.marched.reset();
      if (!statics(stage)) return;
      continue;
    }
    if (stage.p_delta && geometric_ == nullptr && !second_order()) return;
    if (rest_ != nullptr) release();
    if (!run_.handover && run_.step == 0 && keeping_.from == nullptr) {  // the first dynamic stage begins
      if (run_.stage > 0) bases_.note_rest(run_.state);
      add_initial_state();
      if (keeping_.begin) return keeping_.begin(run_);
    }
    const Bulk stage_bulk(plan_.solver->matrices_of(model_), geometric_.get());
    if (!dynamics(stage, stage_bulk)) return;
  }
}

/// A joint with an initial gap was broken before the analysis: its law remembers an opening from zero to that gap (the SDM's jump is the
/// gap), or the first step would take the gap for a stretched joint.
void Runner::remember_gaps() {
  const Vector old = Vector::Zero(laws_->history);
  for (const Block& block : blocks_of(model_, *laws_).blocks) {
    const Vector gap = gap_.segment(block.first, block.rows()).cwiseMax(0), closed = Vector::Zero(block.rows());
    if (block.law == nullptr || block.law->num_history(block.batch.components) == 0 || gap.isZero(0)) continue;
    Vector traction(block.rows());
    LawResponse response;
    response.traction = traction.data();
    response.now = run_.state.history.data() + block.first_history;
    block.law->respond(block.batch, closed.data(), gap.data(), old.data() + block.first_history, response);
  }
}

/// The initial state of the first dynamic stage comes on top of what the static stages left: laws answer the change of the openings, a
/// constraint that is opened by it has no force any more.
void Runner::add_initial_state() {
  const Eigen::Index n = model_.free();
  if (plan_.initial_velocity.size() == n) run_.state.velocity += plan_.initial_velocity;
  if (plan_.initial_displacement.size() != n || plan_.initial_displacement.isZero(0)) return;
  run_.state.displacement += plan_.initial_displacement;
  const Vector from = run_.state.opening;
  run_.state.opening += b_ * plan_.initial_displacement;
  const Vector old = run_.state.history;
  for (const Block& block : blocks_of(model_, *laws_).blocks) {
    const int points = block.batch.points, normal = block.first + block.batch.normal();
    if (block.law != nullptr) {
      LawResponse response;
      response.traction = run_.state.force.data() + block.first;
      response.now = run_.state.history.data() + block.first_history;
      block.law->respond(block.batch, from.data() + block.first, run_.state.opening.data() + block.first, old.data() + block.first_history,
                         response);
    }
    for (int c = 0; c < block.batch.components; ++c)
      for (int i = 0; i < points; ++i) {
        double& force = run_.state.force[block.first + c * points + i];
        if (block.law != nullptr)
          force *= block.area[static_cast<std::size_t>(i)];
        else if (run_.state.opening[normal + i] > 0)
          force = 0;
      }
  }
  run_.state.mean_force = run_.state.force;
}

ForceStage Runner::force_stage(const Stage& stage) const {
  return {model_, second_order_of(stage), run_.held.size() > 0 ? &run_.held : nullptr};
}

/// Tells the observer, if there is one, of the present state. Its time is not that of the run.
void Runner::show(const Stage& stage, const Stepper* stepper, long step, bool last) {
  if (!observe_) return;
  bases_.sum_up(stage.step);
  const auto start = std::chrono::steady_clock::now();
  std::optional<State> resting;
  if (rest_ != nullptr) resting = carried();
  const ForceStage forces = force_stage(stage);
  observe_({resting ? *resting : *seen_, stepper, run_.result, static_cast<std::size_t>(&stage - plan_.stages.data()), step, last, forces});
  shown_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

RunResult run(const Model& model, const RunPlan& plan, const std::vector<const Values*>& behaviours, const Watch& watch,
              const Observe& observe, const Keeping* keeping) {
  const Keeping nothing;
  return Runner(model, plan, behaviours, watch, observe, keeping != nullptr ? *keeping : nothing).go();
}

}  // namespace uplift
