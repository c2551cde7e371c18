#include "uplift/session/reduce.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "uplift/base/file.h"
#include "uplift/base/text.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/dynamics/plastic_bulk.h"
#include "uplift/model/matrix_sum.h"
#include "uplift/reduction/projection.h"
#include "uplift/reduction/training.h"
#include "uplift/session/control_runs.h"
#include "uplift/session/steps.h"

namespace uplift {

namespace {

constexpr const char* key = "reduced_model";

/// Of the present state of the input: what a reduced model does not represent, in words; empty without any.
std::string not_represented(const BuiltCase& built) {
  const RunPlan& plan = built.plan;
  if (dynamic_stage(plan) == nullptr) return "static stages alone";
  if (PlasticBulk(built.model).any()) return "a solid that yields";
  if (std::ranges::any_of(plan.stages, &Stage::p_delta)) return "p_delta, which changes the stiffness";
  if (!stopping_stages(plan).empty()) return "a static stage after a dynamic one";
  const auto is_cone = [](const Interface& interface) { return interface.cone != nullptr; };
  if (!plan.method->constrains() && std::ranges::any_of(built.model.interfaces, is_cone))
    return "a penalty, which follows from the structure";
  const auto is_force = [](const Request& request) { return request.kind == Request::Kind::force; };
  if (!plan.envelopes.empty() || std::ranges::any_of(plan.requests, is_force)) return "an output of forces inside the structure";
  return {};
}

void refuse(const BuiltCase& built, const Where& where) {
  if (std::string found = not_represented(built); !found.empty())
    throw InputError(where, key,
                     "an elastic structure whose stiffness does not change, in dynamic stages, with outputs of motions and of "
                     "interfaces, for a reduced model",
                     found);
}

/// The vector in coordinates of the basis; exact where the basis holds it.
Vector coordinates(const EnergyProduct& product, const Matrix& basis, const Vector& x) {
  return basis.transpose() * product.times(x);
}

/// What static stages apply.
Vector dead_force(const Model& model) {
  Vector force = Vector::Zero(model.free());
  for (const TimeLoad& load : model.time_loads)
    if (load.dead) force += load.factor(0) * load.shape;
  return force;
}

bool is_same(const Vector& a, const Vector& b) {
  return a.size() == b.size() && a == b;
}

/// Whether the static stages and the initial state of a plan under dead loads are those that were computed.
bool is_same(const ReducedStart& start, const Vector& dead, const RunPlan& plan) {
  return is_same(start.dead_force, dead) && is_same(start.velocity, plan.initial_velocity) &&
         is_same(start.displacement, plan.initial_displacement);
}

/// The full unknowns from which a run without pictures makes its results, ascending.
std::vector<int> unknowns_of_results(const BuiltCase& built) {
  std::set<int> found;
  const auto add_node = [&](int node) {
    for (int k = 0; k < built.model.space.unknowns(); ++k) found.insert(built.model.space.unknowns() * node + k);
  };
  for (const Request& request : built.plan.requests) {
    found.insert(request.unknown);
    if (request.below >= 0) found.insert(request.below);
  }
  for (const FloorRequest& floor : built.plan.floors) add_node(floor.node);
  for (const std::vector<int>& base : built.plan.bases) std::ranges::for_each(base, add_node);
  return {found.begin(), found.end()};
}

/// Translations, in all directions, of the nodes whose accelerations are asked for: a direction in which a load does not move a node, by
/// symmetry, is compared with the others.
std::vector<int> floor_unknowns(const BuiltCase& built) {
  std::set<int> nodes;
  for (const FloorRequest& floor : built.plan.floors) nodes.insert(floor.node);
  if (nodes.empty() && built.top >= 0) nodes.insert(built.top);
  std::vector<int> unknowns;
  for (const int node : nodes)
    for (int axis = 0; axis < built.model.space.dimension; ++axis) unknowns.push_back(built.model.space.unknowns() * node + axis);
  return unknowns;
}

}  // namespace

std::optional<ReducedModel> reduce_case(const LoadedCase& loaded, const ReduceOptions& options, const Control& control) {
  const Where where = loaded.read.values.where();
  RunSpec spec = runs_of_case(loaded.read).front();
  spec.pictures = false;
  std::optional<ReducedModel> reduced(std::in_place);
  {
    BuiltCase built = build_run(loaded, spec);
    make_whole(built.model, {&built.plan.initial_displacement, &built.plan.initial_velocity});
    if (options.model) {
      *reduced = *options.model;
      refuse_reduced(*reduced, {"uplift reduce", 0}, built, "--model");
    } else {
      refuse(built, where);
      TrainingOptions training{.frequency = options.frequency, .size = options.size, .target = options.target};
      training.floors = floor_unknowns(built);
      training.loads_floors = !built.plan.floors.empty();
      const Watch watch = control.watch ? control.watch("basis") : Watch();
      training.go_on = [&](double share) { return watch ? watch({.fraction = share}) : !control.is_stopped(); };
      Basis basis = train(built.model, *built.plan.solver, training);
      if (control.is_stopped()) return {};
      if (!basis.why.empty()) throw InputError(where, "", "a structure with a reduced model", basis.why);
      reduced->version = UPLIFT_VERSION;
      reduced->matrices = matrices_hash(built.model);
      reduced->loads = orthonormal_loads(built.model);
      reduced->frequency = options.frequency;
      reduced->energy_frequency = basis.energy_frequency;
      reduced->transfer_error = basis.transfer_error;
      reduced->rigid = basis.rigid;
      reduced->vectors = std::move(basis.vectors);
    }
  }
  if (options.controls > 0) {
    ControlErrors errors = control_errors(loaded, *reduced, options, control);
    const int before = reduced->controls ? reduced->controls->runs : 0;  // more runs than those of an interruption say more
    if (errors.runs == options.controls || errors.runs > before) reduced->controls = std::move(errors);
  }
  return reduced;
}

ReducedModel read_reduced_model_file(const std::string& path, const Where& where, const std::string& name) {
  std::string why;
  std::optional<ReducedModel> found = read_reduced_model(read_file(path), why);
  if (!found) throw InputError(where, name, "a file that `uplift reduce` has written", in_quotes(path) + ": " + why);
  return std::move(*found);
}

std::shared_ptr<const ReducedModel> read_reduced_model_of(const Values& root) {
  if (!root.has(key)) return nullptr;
  const std::filesystem::path path = path_beside(root.where(key), root.text(key));
  return std::make_shared<const ReducedModel>(read_reduced_model_file(path.string(), root.where(key), key));
}

void refuse_reduced(const ReducedModel& reduced, const Where& where, const BuiltCase& built, const std::string& name) {
  refuse(built, where);
  if (matrices_hash(built.model) != reduced.matrices)
    throw InputError(where, name, "the reduced model of this structure",
                     "that of another one: its stiffness, mass, damping, absorbing faces or mesh have changed since `uplift reduce`");
  if (const std::string load = load_outside(built.model, reduced.loads); !load.empty())
    throw InputError(where, name, "a reduced model that was made with all loads of the case; only their size and course in time may change",
                     "one that does not represent the answer to the load " + in_quotes(load) + ": make it anew with `uplift reduce`");
}

void ReducedStart::swap_matrices(Model& model) {
  expansion.swap(model.expansion);
  stiffness.swap(model.stiffness), mass.swap(model.mass), damping.swap(model.damping);
  rows.resize(model.interfaces.size());
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k].swap(model.interfaces[k].b);
}

std::optional<RunState> begin_reduced(const ReducedModel& reduced, const Where& where, BuiltCase& built, const Watch& watch,
                                      RunResult& result, std::optional<ReducedStart>* shared) {
  make_whole(built.model, {&built.plan.initial_displacement, &built.plan.initial_velocity});
  refuse_reduced(reduced, where, built);
  const bool shares = shared != nullptr && built.model.motions.empty();  // prescribed motions open gaps at rest
  const Vector dead = shares ? dead_force(built.at_rest()) : Vector();
  if (shares && *shared && is_same(**shared, dead, built.plan)) {
    (*shared)->swap_matrices(built.model);
    project_loads(built.model, (*shared)->basis);
    built.plan.rest.reset();
    return (*shared)->state;
  }
  if (shared != nullptr) shared->reset();
  std::optional<RunState> begin;
  Keeping keeping;
  keeping.begin = [&](const RunState& state) { begin = state; };
  result = run(built.model, built.plan, built.behaviours, watch, {}, &keeping);
  if (!begin) return {};
  const EnergyProduct product(built.model.stiffness, built.model.mass, reduced.energy_frequency);
  Matrix basis = reduced.vectors;
  constexpr double least = 1e-11;  // share of the state that is left out
  State& state = begin->state;
  for (const Vector* part : {&state.displacement, &state.velocity}) append(product, *part, least, basis);
  const std::vector<int> shown = shares && built.plan.frames == 0 ? unknowns_of_results(built) : std::vector<int>();
  project_on_modes(built.model, reduced.energy_frequency, basis, shown.empty() ? nullptr : &shown);
  state.displacement = coordinates(product, basis, state.displacement);
  state.velocity = coordinates(product, basis, state.velocity);
  state.acceleration.setZero(basis.cols());
  if (begin->held.size() > 0) begin->held = (basis.transpose() * begin->held).eval();
  built.plan.rest.reset();
  if (shares) {
    ReducedStart& made = shared->emplace();
    made.state = *begin, made.basis = std::move(basis), made.dead_force = dead;
    made.velocity = built.plan.initial_velocity, made.displacement = built.plan.initial_displacement;
  }
  return begin;
}

}  // namespace uplift
