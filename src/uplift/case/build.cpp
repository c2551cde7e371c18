#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/base/text.h"
#include "uplift/case/advice/history_forecast.h"
#include "uplift/case/build/bed.h"
#include "uplift/case/build/behaviours.h"
#include "uplift/case/build/criteria.h"
#include "uplift/case/build/output.h"
#include "uplift/case/build/roles.h"
#include "uplift/case/build/stages.h"
#include "uplift/case/build/water.h"
#include "uplift/case/drawn_parts.h"
#include "uplift/case/ground/ground.h"
#include "uplift/case/schema/sections.h"
#include "uplift/case/shown.h"
#include "uplift/laws/stated.h"
#include "uplift/linear/large.h"
#include "uplift/model/base_size.h"
#include "uplift/model/check.h"
#include "uplift/model/function_jumps.h"
#include "uplift/model/matrix_sum.h"
#include "uplift/model/model_matrices.h"
#include "uplift/model/tuned_mass.h"

namespace uplift {
namespace {

constexpr int most_pictured = 20'000'000;  // numbers kept for the animation: 160 MB

/// The law or cone of an interface in this run.
const Values& behaviour_of(const InterfacePart& part, const RunSpec& spec) {
  if (part.footprint) {
    if (spec.law && spec.interface == part.name)
      throw InputError(spec.law->where(), spec.law->path(), "the law of an interface",
                       in_quotes(part.name) + ", a foundation, which has a model");
    return *part.behaviour;
  }
  const bool replaced = spec.law && (spec.interface.empty() || spec.interface == part.name);
  return replaced ? *spec.law : *part.behaviour;
}

/// With the numbers of the soil.
const Values& behaviour_on_soil(const Values& behaviour, const InterfaceFacts& facts, const RunSpec& spec, Space space, BuiltCase& built) {
  auto derived = law_on_soil(behaviour, facts.soil.get(), space.dimension);
  if (!derived) return behaviour;
  if (&behaviour == spec.law && spec.stiffness_ratio) fail(behaviour, "", "numbers in the law of a stiffness sweep", "\"soil\"");
  built.derived.push_back(std::move(derived));
  return *built.derived.back();
}

/// `like`: the interfaces get the components that they have in this model; null: as many as their law and supports leave.
void add_interfaces(const Case& read, const RunSpec& spec, const Model* like, ModelBuilder& builder, CaseNames& names, BuiltCase& built) {
  if (like) builder.keep_tangents();
  std::vector<InterfacePart> parts = interface_parts(read, spec.rigid_ground, builder, names);
  for (InterfacePart& part : parts) {
    if (std::string note = note_of_water(part); !note.empty()) built.notes.push_back(std::move(note));
    Joint& joint = part.joint;
    const Values& behaviour = behaviour_on_soil(behaviour_of(part, spec), joint.facts, spec, names.space, built);
    InterfaceSpec made;
    made.name = part.name;
    made.footprint = part.footprint;
    made.rotations = part.footprint ? part.footprint->rotations() : 0;
    made.components = part.footprint ? part.footprint->components()
                      : like         ? like->interfaces[built.facts.size()].batch.components
                                     : components_of(behaviour, names.space);
    made.points = std::move(joint.points);
    made.reference = joint.reference;
    made.behaviour = behaviour.type();
    made.law = make_law(behaviour, made.footprint);
    if (!made.law) made.cone = make_part(cone_catalog(), behaviour);
    if (made.cone && joint.facts.soil)
      fail(behaviour, "", "a traction law on [interface.footing.soil]: constraints know no stiffness", in_quotes(behaviour.type()));
    if (made.cone && !joint.facts.why_no_cones.empty())
      fail(behaviour, "", fmt::format("a traction law on {}: constraints at all of its points are too many", joint.facts.why_no_cones),
           in_quotes(behaviour.type()));
    const StatedNumbers stated = stated_numbers(behaviour);
    if (stated.friction) joint.facts.friction = *stated.friction;
    if (stated.cohesion) joint.facts.cohesion = *stated.cohesion;
    if (made.footprint && stated.friction_angle) joint.facts.friction = std::tan(*stated.friction_angle);
    if (made.law) joint.facts.tension = made.law->scales().strength;
    built.facts.push_back(std::move(joint.facts));
    built.behaviours.push_back(&behaviour);
    if (auto dashpot = part.foundation ? radiation_dashpot(*part.foundation, *part.footprint, names) : nullptr)
      builder.add_element(std::move(dashpot), part.foundation->soil->where("radiation"));
    builder.add_interface(std::move(made), part.table->where());
  }
  if (spec.law && std::ranges::all_of(parts, [](const InterfacePart& part) { return part.footprint.has_value(); }))
    throw InputError(spec.law->where(), spec.law->path(), "an interface that takes this law", "foundations alone, which have a model");
  if (spec.law && !spec.interface.empty()) names.interfaces.find(spec.interface, spec.law->where(), spec.law->path());
}

/// What a foundation cannot stand beside.
void check_foundation(const Values& model, bool cone, const Values* method) {
  if (method && method->type() != "newton")
    fail(*method, "", "method = \"newton\" with a foundation: its ground gives way, and methods of constraints have nothing to hold",
         in_quotes(method->type()));
  if (cone) fail(model, "", "traction laws in the interfaces beside a foundation, whose ground gives way", "a constraint in one of them");
}

/// Method and rule; the method must suit the behaviours.
void add_method(const Case& read, const RunSpec& spec, BuiltCase& built) {
  const Values& root = read.values;
  const Values* method = spec.method ? spec.method : read.input->method;
  bool cone = false;
  for (const Interface& interface : built.model.interfaces) cone = cone || interface.cone != nullptr;
  for (std::size_t k = 0; k < built.model.interfaces.size(); ++k)
    if (built.model.interfaces[k].footprint) check_foundation(*built.behaviours[k], cone && !spec.bonded, spec.bonded ? nullptr : method);
  if (spec.bonded) method = nullptr;
  if (method && cone && method->type() == "newton")
    fail(*method, "", "a method for cones (penalty, augmented_lagrangian, lagrange), or a traction law", "\"newton\" with a cone");
  if (method && !cone && !spec.law && method->type() == "penalty")
    fail(*method, "", "a cone (law = \"unilateral\" or \"coulomb\"), or method = \"newton\"", "\"penalty\" with a traction law");
  const Values automatic = check_part(Raw{std::string(standard_method(cone)), root.where(), "method"}, contact_methods());
  built.plan.method = make_part(method_catalog(), method ? *method : automatic);
  // a joint that gives way keeps its velocity: a correction is for constraints, and for a stiff law where the user asks for it
  const Values* impact = spec.bonded ? nullptr : spec.impact ? spec.impact : read.input->impact;
  const Values standard =
      check_part(Raw{std::string(cone && !spec.bonded ? "project_hold" : "none"), root.where(), "impact"}, impact_rules());
  built.plan.impact = make_part(impact_catalog(), impact ? *impact : standard);
  // these turn the velocity relative to a support round in every step: points of a moving one would hold tension
  if (impact && built.plan.impact->force_includes_impulse())
    for (const PrescribedMotion& motion : built.model.motions)
      if (!motion.opening.isZero(0))
        fail(*impact, "", "\"project_hold\" or \"project\" for points on a support that motion " + in_quotes(motion.name) + " moves",
             in_quotes(impact->type()));
}

/// Where a node of the case is given; of a node of the mesh the file.
std::function<Where(const std::string&)> places_of_nodes(const Case& read) {
  return [&read](const std::string& name) {
    const auto found = std::ranges::find(read.input->nodes, name, &CaseNode::name);
    return found == read.input->nodes.end() ? read.values.where() : found->where();
  };
}

/// The mass that a tuned point mass gets: that of the structure without it, see tuned_mass.
std::vector<double> tuned_masses(const Case& read, const RunSpec& spec) {
  const CaseMass* tuned = nullptr;
  for (const CaseMass& mass : read.input->masses) {
    if (mass.mass) continue;
    if (tuned) fail(mass, "tuned_frequency", "at most one tuned mass", "a second one");
    tuned = &mass;
  }
  if (!tuned) return {};
  BuiltCase without;
  CaseNames names;
  names.space = read.input->space;
  ModelBuilder builder(names.space);
  add_nodes(*read.input, builder, names);
  add_mesh(read, builder, names);
  add_functions(read, names);
  add_structure(read, builder, names, {0.0}, true);
  add_interfaces(read, spec, nullptr, builder, names, without);
  const Model model = builder.finish();
  check_static(model, places_of_nodes(read));  // a loose body is named as such, not as a mass that cannot be tuned
  return {tuned_mass(model, names.node(tuned->node), tuned->tuned_frequency, tuned->where("tuned_frequency"))};
}

/// Supports that start or stop with a velocity pass an impulse on to masses that they share with free nodes. It acts within the steps
/// beside that time. What moves from the beginning on, or stops with the run, has none.
void add_pulses(const CaseInput& input, const std::vector<Stage>& stages, std::vector<std::shared_ptr<const TimeFunction>>& functions) {
  if (input.motions.empty()) return;
  for (std::shared_ptr<const TimeFunction>& function : functions) {
    if (!function) continue;
    std::vector<FunctionBend> pulses;
    double begin = 0;
    for (const Stage& stage : stages) {
      if (stage.type != Stage::Type::dynamics) continue;
      // a pulse lies within the steps of one stage: at its ends it comes up to a step later or earlier
      const double end = begin + stage.step * std::max(1.0, std::round(stage.duration / stage.step));
      const double least = begin + stage.step, most = std::max(least, end - stage.step), round_off = 1e-6 * stage.step;
      for (const FunctionBend& bend : bends_of(*function))
        if (bend.time > (begin > 0 ? begin - round_off : round_off) && bend.time < end - round_off && bend.change != 0)
          pulses.push_back({std::clamp(bend.time, least, most), bend.change, stage.step});
      begin = end;
    }
    if (!pulses.empty()) function = with_pulses(std::move(function), std::move(pulses));
  }
}

/// The model of a run. `dynamic`: the model without the supports of static stages alone, when that with them is wanted; null: without them.
Model make_model(const Case& read, const RunSpec& spec, const std::vector<double>& tuned, const Model* dynamic, CaseNames& names,
                 BuiltCase& built) {
  names.space = read.input->space;
  ModelBuilder builder(names.space);
  add_nodes(*read.input, builder, names);
  add_mesh(read, builder, names);
  names.instead = spec.motion;
  names.motion_factor = spec.motion_factor;
  names.functions_used = &built.functions;
  names.share = newmark_share(built.plan.stages);
  add_functions(read, names);
  add_pulses(*read.input, built.plan.stages, names.functions_made);
  add_structure(read, builder, names, tuned, dynamic != nullptr);
  add_ties(*read.input, builder, names);
  add_faces(read, builder, names);
  if (!dynamic)
    add_free_field(*read.input, built.plan.stages, spec.damping ? spec.damping->made : BulkDamping{}, bulk_solver(read), builder, names);
  add_interfaces(read, spec, dynamic, builder, names, built);
  add_loads(*read.input, builder, names);
  if (spec.damping) builder.set_damping(spec.damping->made);
  built.beams = names.beams;
  builder.set_home(home_of(*bulk_solver(read)));
  if (names.solids) names.solids->forget_edges();  // before the model is largest
  return builder.finish();
}

/// The model of the static stages, with the laws that the run takes.
std::shared_ptr<Model> resting_model(const Case& read, const RunSpec& spec, const std::vector<double>& tuned, const BuiltCase& built) {
  BuiltCase scratch;
  CaseNames names;
  auto rest = std::make_shared<Model>();
  move_model(make_model(read, spec, tuned, &built.model, names, scratch), *rest);
  for (std::size_t k = 0; k < rest->interfaces.size(); ++k) {
    Interface& interface = rest->interfaces[k];
    interface.law = make_law(*built.behaviours[k], interface.footprint);
    interface.cone = interface.law ? nullptr : make_part(cone_catalog(), *built.behaviours[k]);
    interface.behaviour = built.model.interfaces[k].behaviour;
    interface.gap = built.model.interfaces[k].gap;
  }
  return rest;
}

/// A bonded joint in the place of a constraint is much stiffer than the structure: an initial displacement or velocity that moves one side
/// of it against the other would fling the structure away. The bonded run begins without it. `constraints`: of the case, for each
/// interface.
void leave_out_initial_motion(const std::vector<char>& constraints, BuiltCase& built) {
  for (Vector* motion : {&built.plan.initial_displacement, &built.plan.initial_velocity}) {
    if (motion->size() == 0) continue;
    const double least = 1e-9 * motion->cwiseAbs().maxCoeff();
    for (std::size_t k = 0; k < constraints.size(); ++k)
      if (constraints[k] && motion->size() > 0 && Vector(built.model.interfaces[k].b * *motion).cwiseAbs().maxCoeff() > least)
        motion->resize(0);
  }
}

/// N/m; of rigid bodies alone any number does.
double largest_stiffness(const Model& model) {
  const double largest = model.free() > 0 ? diagonal_of(model, &Model::stiffness).maxCoeff() : 0;
  return largest > 0 ? largest : 1e9;
}

/// Replaces laws that depend on the compliance of the model: the swept stiffness, the bonded joint.
void adapt_laws(const Case& read, const RunSpec& spec, BuiltCase& built) {
  if (!spec.stiffness_ratio && !spec.bonded) return;
  const Stage* stage = dynamic_stage(built.plan);
  if (!stage && spec.stiffness_ratio) fail(*spec.law, "", "a dynamic stage, at whose step k F_ii is taken", "static stages alone");
  std::vector<StiffnessRatio> ratios;
  if (stage) ratios = stiffness_ratios(built.model, *stage, *bulk_solver(read));
  for (std::size_t k = 0; k < built.model.interfaces.size(); ++k) {
    Interface& interface = built.model.interfaces[k];
    const Values& behaviour = *built.behaviours[k];
    std::unique_ptr<const Values> derived;
    if (spec.bonded) interface.gap.setZero();  // connected as drawn: closing the gaps would prestress the structure
    if (spec.bonded && interface.footprint) {
      derived = std::make_unique<const Values>(bonded_foundation(behaviour, interface));
    } else if (spec.bonded) {
      std::vector<double> stiffness(static_cast<std::size_t>(interface.batch.components));
      if (interface.law)
        interface.law->closed_stiffness(interface.batch.components, stiffness.data());
      else  // a constraint: stiff beside the structure
        std::fill(stiffness.begin(), stiffness.end(),
                  1e3 * (stage ? 1 / ratios[k].compliance : largest_stiffness(built.model)) / interface.area.mean());
      derived = std::make_unique<const Values>(bonded_behaviour(behaviour, stiffness));
      built.laws_of_step = built.laws_of_step || !interface.law;
    } else if (&behaviour == spec.law) {
      const std::string& key = spec.stiffness_parameter;
      if (!behaviour.items().contains(key) || !behaviour.has(key))
        fail(behaviour, "", "a law with the parameter \"" + key + "\"", "\"" + behaviour.type() + "\"");
      built.laws_of_step = true;
      derived = std::make_unique<const Values>(with_number(behaviour, key, behaviour.number(key) * *spec.stiffness_ratio / ratios[k].most));
    } else {
      continue;
    }
    interface.law = make_law(*derived, interface.footprint);
    interface.cone.reset();
    interface.behaviour = derived->type();
    built.behaviours[k] = derived.get();
    built.derived.push_back(std::move(derived));
  }
}

/// A base of width B that turns by the limit theta opens by B theta at its toe: as far, everywhere, the displacement is no smaller beside
/// the structure than there. No gap is a share of its size, in all units of length alike.
void set_limits(const CaseLimits& limits, const Model& model, RunPlan& plan) {
  const double size = base_size(model);
  plan.rotation_limit = limits.rotation;
  plan.separation_limit = limits.separation.value_or(limits.rotation * size);
  plan.gap_tolerance = limits.gap_tolerance.value_or(size > 0 ? closed_share * size : 1e-9);
}

/// Tells of interfaces that were divided by their normals.
void note_divided(BuiltCase& built) {
  for (const InterfaceFacts& walls : built.facts)
    for (const InterfaceFacts& base : built.facts)
      if (walls.name == base.name + " walls" && walls.role == Role::wall)
        built.notes.push_back(
            fmt::format("the interface \"{}\" has faces of a base ({:.4g} m2) and of walls ({:.4g} m2): the walls are the "
                        "interface \"{}\"",
                        base.name, base.area, walls.area, walls.name));
}

InterfaceSolver interface_solver(const std::string& word) {
  return word == "direct" ? InterfaceSolver::direct : word == "krylov" ? InterfaceSolver::krylov : InterfaceSolver::automatic;
}

}  // namespace

std::string_view to_string(Role role) {
  return role == Role::base ? "base" : "wall";
}

std::size_t BuiltCase::bases() const {
  const auto count = static_cast<std::size_t>(std::ranges::count(facts, Role::base, &InterfaceFacts::role));
  return count > 0 ? count : facts.size();
}

bool BuiltCase::is_strip() const {
  return model.space.dimension == 2 && !facts.empty() &&
         std::ranges::all_of(facts, [](const InterfaceFacts& each) { return each.depth == 1; });
}

namespace {

void put_name(const RunSpec& spec, RunPlan& plan) {
  plan.name = spec.name;
  plan.label = spec.label;
  plan.group = spec.group;
}

/// The process that holds a model whose matrices are distributed keeps no more of a picture than is drawn: all nodes of all pictures
/// would take as much as everything else there.
void choose_pictures(const Case& read, const RunSpec& spec, BuiltCase& built) {
  const int wanted = spec.pictures ? read.input->output.frames : 0;
  built.plan.frames = std::min(wanted, std::max(2, most_pictured / std::max(1, built.model.full_unknowns())));
  built.plan.pictured.clear();
  if (wanted == 0 || built.model.distributed == nullptr || built.model.space.dimension < 3) return;
  built.plan.pictured = nodes_drawn_in_space(read, built, drawn_parts(read, built));
  const int beside = 3 * static_cast<int>(built.plan.stages.size());  // of the beginning and of the largest uplift of every stage
  built.plan.frames = std::min(wanted, std::max(2, static_cast<int>(most_pictures_in_space(built.plan.pictured.size())) - beside));
}

/// What is wrong with a joint because of the law of a variant is told at that law.
void tell_at_law(const RunSpec& spec, const BuiltCase& built, Model& model) {
  for (std::size_t k = 0; k < built.behaviours.size(); ++k)
    if (built.behaviours[k] == spec.law) model.assembly.interface_where[k] = spec.law->where();
}

}  // namespace

bool change_steps(const Case& read, const RunSpec& spec, BuiltCase& built) {
  if (built.laws_of_step) return false;
  std::vector<Stage> stages = stages_of(read, spec);
  stages.swap(built.plan.stages);
  if (!change_motion(read, spec, built)) {
    stages.swap(built.plan.stages);
    return false;
  }
  put_name(spec, built.plan);
  choose_pictures(read, spec, built);
  return true;
}

BuiltCase build(const Case& read, const RunSpec& spec) {
  const Values& root = read.values;
  BuiltCase built;
  CaseNames names;
  const std::vector<double> tuned = tuned_masses(read, spec);
  if (!tuned.empty()) {
    built.tuned_mass = tuned.front();
    built.notes.push_back(fmt::format("the tuned mass is {:.10g} kg", built.tuned_mass));
  }
  built.plan.stages = stages_of(read, spec);
  check_second_order_water(read);
  move_model(make_model(read, spec, tuned, nullptr, names, built), built.model);
  tell_at_law(spec, built, built.model);
  const bool released = any_released(*read.input);
  const bool rests = std::ranges::any_of(built.plan.stages, [](const Stage& stage) { return stage.type == Stage::Type::statics; });
  if (!released && rests) check_static(built.model, places_of_nodes(read));
  if (dynamic_stage(built.plan)) check_dynamic(built.model, root.where());
  built.motions = motions_used(read, spec.motion, spec.motion_factor);

  RunPlan& plan = built.plan;
  put_name(spec, plan);
  plan.expected_to_fail = spec.expected_to_fail;
  plan.solver = bulk_solver(read);
  plan.interface_solver = interface_solver(read.input->interface_solver);
  std::vector<char> constraints;
  for (const Interface& interface : built.model.interfaces) constraints.push_back(interface.cone != nullptr);
  adapt_laws(read, spec, built);
  if (released) {
    check_release(read.input->stages, plan.stages);
    const auto rest = resting_model(read, spec, tuned, built);
    tell_at_law(spec, built, *rest);
    plan.rest = rest;
    check_static(*plan.rest, places_of_nodes(read));
  }
  add_method(read, spec, built);
  if (const Stage* stage = dynamic_stage(plan);
      stage != nullptr && plan.impact->acts() && (!stage->path_average || plan.method->constrains()))
    check_impulses(built.model);
  add_initial(*read.input, names, built);
  if (spec.bonded) leave_out_initial_motion(constraints, built);
  find_shown(read, names, built);
  plan.created_limit = read.input->energy.created_limit;
  plan.stop_at_limit = read.input->energy.stop_at_limit;
  set_limits(read.input->limits, built.model, plan);
  for (const InterfaceFacts& facts : built.facts) plan.bases.push_back(facts.upper), plan.facets.push_back(facts.facets);
  for (std::size_t k = 0; k < built.facts.size(); ++k) plan.is_wall.push_back(k >= built.bases());
  note_divided(built);
  plan.every = read.input->output.every;
  choose_pictures(read, spec, built);
  add_requests(read, names, built);
  add_combined(built);
  if (!spec.stiffness_ratio) add_floors(read, built);
  built.verdict_request = verdict_request(read.input->verdict, built);
  plan.window = built.verdict_request.window;
  if (read.input->compare) check_columns(read.input->compare->agree_on, plan.requests);
  check_history_memory(read, built);
  return built;
}

}  // namespace uplift
