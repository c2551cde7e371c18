#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "uplift/base/format.h"
#include "uplift/base/units.h"
#include "uplift/case/advice/content.h"
#include "uplift/case/advice/input_warnings.h"
#include "uplift/case/advice/interface_warnings.h"
#include "uplift/case/advice/step_suggestion.h"
#include "uplift/case/advice/swaying_solids.h"
#include "uplift/case/ground/ground.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/mesh/torn.h"
#include "uplift/model/damping.h"
#include "uplift/model/hinges.h"
#include "uplift/model/matrix_sum.h"
#include "uplift/model/tuned_mass.h"

namespace uplift {
namespace {

struct Magnitude {
  const char *table, *key, *unit;
  double least, most;
  const char* hint;
};
/// What civil structures have; outside, a unit is probably missing.
constexpr std::array<Magnitude, 12> usual{{{"beam", "E", "Pa", 1e8, 1e12, "concrete is about 3e10 Pa, steel 2.1e11 Pa"},
                                           {"beam", "I", "m4", 1e-9, 1e5, "1 cm4 is 1e-8 m4"},
                                           {"beam", "A", "m2", 1e-6, 1e4, "1 cm2 is 1e-4 m2"},
                                           {"beam", "density", "kg/m3", 100, 30000, "concrete is about 2500 kg/m3"},
                                           {"mass", "mass", "kg", 1e-1, 1e10, "1 t is 1000 kg"},
                                           {"mass", "tuned_frequency", "Hz", 1e-2, 1e3, "in Hz, not in rad/s"},
                                           {"rigid", "mass", "kg", 1e-1, 1e10, "1 t is 1000 kg"},
                                           {"solid", "E", "Pa", 1e5, 1e12, "soil has 1e7 to 1e9 Pa, concrete about 3e10 Pa"},
                                           {"solid", "shear_wave_speed", "m/s", 20, 5000, "soil has 100 to 800 m/s"},
                                           {"solid", "density", "kg/m3", 10, 30000, "soil is about 1900 kg/m3, concrete 2500 kg/m3"},
                                           {"stage", "step", "s", 1e-7, 0.5, "1 ms is 0.001 s"},
                                           {"stage", "duration", "s", 1e-4, 1e5, "in seconds"}}};

constexpr Magnitude water_weight{"water", "unit_weight", "N/m3", 9e3, 1.3e4, "water has 9810 N/m3; 9.81 kN/m3 is meant for 9.81"};

void warn_magnitude(const Values& table, const Magnitude& each, std::vector<std::string>& said) {
  if (!table.given(each.key)) return;
  const double value = table.number(each.key);
  if (value != 0 && (value < each.least || value > each.most))
    said.push_back(fmt::format("{}:{}: {} = {:g} {} is unusual for a structure ({}); is the unit right?", table.where(each.key).file,
                               table.where(each.key).line, table.path(each.key), value, each.unit, each.hint));
}

void warn_magnitudes(const Case& read, std::vector<std::string>& said) {
  for (const Magnitude& each : usual)
    for (const Values& table : read.values.tables(each.table)) warn_magnitude(table, each, said);
  for (const CaseInterface& interface : read.input->interfaces)
    if (interface.water) warn_magnitude(*interface.water->table, water_weight, said);
}

/// A density alone makes no mass.
void warn_massless_beams(const Case& read, std::vector<std::string>& said) {
  for (const CaseElement& beam : read.input->elements_at(ElementPlace::lines))
    if (has_idle_density(*beam.table))
      said.push_back(
          fmt::format("{}:{}: the beam \"{}\" has neither mass nor weight, in spite of its density: add mass = \"consistent\", or "
                      "mass = \"none\" where other parts stand for it",
                      beam.where("density").file, beam.where("density").line, beam.name.name));
}

/// Static stages apply what is constant, and motions as they are at t = 0.
void warn_idle_functions(const Case& read, const BuiltCase& built, std::vector<std::string>& said) {
  if (!statics_alone(built.plan)) return;
  const auto say = [&](const CaseTable& table, const char* name) {
    said.push_back(
        fmt::format("{}:{}: this [[{}]] has no effect: it has a function of time, and static stages apply constant loads "
                    "alone; leave the function out, or add a dynamic stage",
                    table.where().file, table.where().line, name));
  };
  for (const CaseLoad& load : read.input->loads)
    if (load.function) say(load, "load");
  for (const CaseGround& ground : read.input->grounds) say(ground, "ground_acceleration");
  for (const CaseMotion& motion : read.input->motions)
    if (!motion.function && parse_quantity(motion.amplitude, motion.turns ? "rad" : "m").value == 0)
      said.push_back(fmt::format("the prescribed motion \"{}\" has no effect: its amplitude is 0", motion.name));
  for (const PrescribedMotion& motion : built.model.motions)
    if (const auto table = std::ranges::find(read.input->motions, motion.name, &CaseMotion::name);
        motion.function->value(0) == 0 && (table == read.input->motions.end() || table->function))
      said.push_back(
          fmt::format("the prescribed motion \"{}\" has no effect: static stages apply the value that its function has at t = 0, "
                      "which is 0",
                      motion.name));
}

/// The geometric stiffness takes the forces of a static stage, and solids have none.
void warn_p_delta(const Case& read, const BuiltCase& built, std::vector<std::string>& said) {
  const auto wanted = std::ranges::find_if(read.input->stages, &CaseStage::p_delta);
  if (wanted == read.input->stages.end()) return;
  if (const double share = second_order_of_solids(built); share > least_of_solids)
    said.push_back(
        fmt::format("{}:{}: p_delta computes no second-order effects of solids, and {} of the second-order moment of the weight arises in "
                    "them; make the part rigid with [[rigid]], or of beams",
                    wanted->where("p_delta").file, wanted->where("p_delta").line, percent(share)));
  bool stood = false;
  for (const CaseStage& stage : read.input->stages) {
    if (stage.p_delta && !stage.statics && !stood)
      said.push_back(
          fmt::format("{}:{}: p_delta has no effect here: no static stage comes before, whose forces make the geometric stiffness",
                      stage.where("p_delta").file, stage.where("p_delta").line));
    stood = stood || stage.statics;
  }
}

/// Without a static stage the weight acts suddenly: twice the settlement, and uplift on the rebound.
void warn_sudden_weight(const BuiltCase& built, std::vector<std::string>& said) {
  const std::vector<Stage>& stages = built.plan.stages;
  if (stages.empty() || stages.front().type == Stage::Type::statics || built.plan.initial_displacement.size() > 0) return;
  const double weight = built.model.assembly.gravity.norm();
  const bool falls =
      std::ranges::any_of(built.model.time_loads, [](const TimeLoad& time_load) { return time_load.dead && !time_load.shape.isZero(0); });
  if (weight > 0 && falls)
    said.push_back(
        "the weight acts suddenly at t = 0, because no static stage comes before the dynamic one: the structure oscillates about its "
        "equilibrium with twice the settlement; put a [[stage]] with type = \"static\" first");
}

/// A dynamic stage after a static one in which nothing happens.
void warn_no_excitation(const BuiltCase& built, std::vector<std::string>& said) {
  const Model& model = built.model;
  const RunPlan& plan = built.plan;
  if (!dynamic_stage(plan) || plan.stages.front().type != Stage::Type::statics) return;
  if (plan.initial_displacement.size() > 0 || plan.initial_velocity.size() > 0) return;
  if (!model.grounds.empty() || !model.motions.empty() || !model.time_load_tables.empty() || !varying_loads(model).empty()) return;
  said.push_back(
      "nothing drives the dynamic stage: there is no ground acceleration, incident wave, prescribed motion, load with a function or "
      "initial motion, and the structure stays as the static stage leaves it");
}

/// The same table twice acts twice. `key`: a text that the same tables share.
template <class Table, class Key, class Same>
void warn_repeated(const std::vector<Table>& tables, const char* name, const Key& key, const Same& same, std::vector<std::string>& said) {
  std::unordered_map<std::string, std::vector<const Table*>> seen;
  for (const Table& table : tables) {
    std::vector<const Table*>& others = seen[key(table)];
    const auto first = std::ranges::find_if(others, [&](const Table* other) { return same(*other, table); });
    if (first == others.end())
      others.push_back(&table);
    else
      said.push_back(fmt::format("{}:{}: this [[{}]] is the same as that of line {}: both act, so the effect is doubled",
                                 table.where().file, table.where().line, name, (*first)->where().line));
  }
}

void warn_repetitions(const CaseInput& input, std::vector<std::string>& said) {
  const auto name = [](const std::optional<NameUsed>& function) { return function ? function->name : std::string(); };
  warn_repeated(
      input.loads, "load", [&](const CaseLoad& load) { return load.of.name() + '\n' + name(load.function); },
      [](const CaseLoad& a, const CaseLoad& b) {
        return a.of.node.has_value() == b.of.node.has_value() && a.force == b.force && a.traction == b.traction &&
               a.pressure == b.pressure && a.moment == b.moment && !a.profile && !b.profile;
      },
      said);
  warn_repeated(
      input.masses, "mass", [](const CaseMass& mass) { return mass.node.name; },
      [](const CaseMass& a, const CaseMass& b) { return a.mass && a.mass == b.mass && a.inertia == b.inertia; }, said);
  warn_repeated(
      input.grounds, "ground_acceleration", [](const CaseGround& ground) { return ground.function.name; },
      [](const CaseGround& a, const CaseGround& b) { return a.direction == b.direction && a.amplitude == b.amplitude; }, said);
}

/// The ground acceleration moves the frame of the whole model, the ground below the absorbing faces too, and the wave comes on top.
void warn_ground_and_wave(const CaseInput& input, std::vector<std::string>& said) {
  const auto wave = std::ranges::find_if(input.absorbing, [](const CaseAbsorbing& each) { return each.incident.has_value(); });
  if (wave == input.absorbing.end() || input.grounds.empty()) return;
  said.push_back(
      fmt::format("{}:{}: this ground acceleration acts together with the incident wave of line {}: the earthquake is counted twice; "
                  "take the wave, or the ground acceleration and a base that is held",
                  input.grounds.front().where().file, input.grounds.front().where().line, wave->incident->where().line));
}

/// Steps are equal, so that a stage has a whole number of them.
void warn_duration(const BuiltCase& built, std::vector<std::string>& said) {
  for (std::size_t k = 0; k < built.plan.stages.size(); ++k) {
    const Stage& stage = built.plan.stages[k];
    if (stage.type != Stage::Type::dynamics) continue;
    const double steps = stage.duration / stage.step, whole = std::max(1.0, std::round(steps));
    if (std::abs(steps - whole) > 1e-6 * whole)
      said.push_back(
          fmt::format("stage {}: the duration of {:.9g} s is not a whole number of steps of {:.9g} s; the stage has {:.9g} steps and ends "
                      "after {:.9g} s",
                      k + 1, stage.duration, stage.step, whole, whole * stage.step));
  }
}

/// Absorbing sides take the ground beside the model to be at rest.
void warn_sides(const Case& read, std::vector<std::string>& said) {
  const std::vector<CaseAbsorbing>& faces = read.input->absorbing;
  if (std::ranges::none_of(faces, [](const CaseAbsorbing& each) { return each.incident.has_value(); })) return;
  for (const CaseAbsorbing& each : faces)
    if (!each.incident && !each.free_field)
      said.push_back(
          fmt::format("{}:{}: {} holds the incident wave back like ground at rest; take free_field = true, or a [[tie]] of opposite sides",
                      each.where().file, each.where().line, each.group.name));
}

/// Absorbing faces on which a support holds the nodes in the dynamic stages too: what would move along a held direction neither goes out
/// nor comes in there. An incident wave that moves along the others is none of its business.
void warn_held_faces(const Case& read, const BuiltCase& built, std::vector<std::string>& said) {
  const int dimension = built.model.space.dimension;
  for (const CaseAbsorbing& face : read.input->absorbing)
    for (const CaseSupport& support : read.input->supports) {
      if (!support.of.group || support.of.name() != face.group.name || support.statics_only) continue;
      const Vec3 motion = face.incident ? incident_motion(*face.incident, built.model.space) : Vec3::Zero();
      std::string held, stopped;
      int count = 0;
      for (int k = 0; k < dimension; ++k) {
        const std::string unknown = std::array{"ux", "uy", "uz"}[static_cast<std::size_t>(k)];
        if (std::ranges::find(support.fixed, unknown, &NameUsed::name) == support.fixed.end()) continue;
        ++count;
        held += (held.empty() ? "" : ", ") + unknown;
        if (std::abs(motion[k]) > 1e-9) stopped += (stopped.empty() ? "" : ", ") + unknown;
      }
      const std::string place = fmt::format("{}:{}: {} is held along {} in the dynamic stages too: ", support.where().file,
                                            support.where().line, face.group.name, held);
      if (!stopped.empty())
        said.push_back(fmt::format("{}the incident {} wave, which moves along {}, does not come in there; take stages = \"static\"", place,
                                   face.incident->wave_word, stopped));
      else if (count == dimension)
        said.push_back(place + "no wave leaves there; take stages = \"static\"");
    }
}

/// Twenty steps per period of the fastest of the first three modes below 50 Hz (earthquakes hold little above 33 Hz).
void warn_step(const BuiltCase& built, std::vector<std::string>& said) {
  const Stage* stage = dynamic_stage(built.plan);
  if (!stage || built.plan.solver->distributed()) return;
  double fastest = 0;
  for (const Mode& mode : bonded_modes(built.at_rest(), 3))
    if (mode.frequency < 50) fastest = std::max(fastest, mode.frequency);
  if (fastest > 0 && stage->step > 1 / (20 * fastest))
    said.push_back(
        fmt::format("the step of {} is coarse for the mode at {:.3g} Hz (bonded base): take at most {} for twenty steps a period",
                    format_quantity(stage->step, "s"), fastest, format_quantity(1 / (20 * fastest), "s")));
}

/// The scheme sees the loads at the steps only.
void warn_loads(const BuiltCase& built, std::vector<std::string>& said) {
  constexpr double accepted = 0.1;
  const Stage* stage = dynamic_stage(built.plan);
  if (!stage) return;
  for (const TimeLoad* time_load : varying_loads(built.model)) {
    const double share =
        unresolved_share(*time_load->function, static_cast<int>(time_load->order), dynamic_duration(built.plan), stage->step);
    if (share > accepted)
      said.push_back(fmt::format("steps of {} do not follow the load \"{}\": straight lines between them differ from it by {} on average",
                                 format_quantity(stage->step, "s"), time_load->name, percent(share)));
  }
}

/// A function whose time lies outside the run, such as a delay counted from the beginning of a longer record, leaves the structure at rest.
void warn_silent_loads(const BuiltCase& built, std::vector<std::string>& said) {
  constexpr double nothing = 1e-12;                     // beside functions of the size of 1, and records in m/s2
  constexpr double most_steps = 1e7, of_a_step = 0.37;  // no whole fraction: a sine may be zero at all steps
  const Stage* stage = dynamic_stage(built.plan);
  const double duration = stage ? dynamic_duration(built.plan) : 0;
  if (!stage || duration > most_steps * stage->step) return;
  for (const TimeLoad* time_load : varying_loads(built.model)) {
    if (time_load->of_motion && time_load->order != TimeLoad::Order::value) continue;  // a support that stays where it is may be meant
    const auto is_zero = [&](double time) { return std::abs(time_load->factor(time)) < nothing; };
    bool silent = true;
    for (long i = 0, count = std::lround(duration / stage->step); silent && i <= count; ++i) {
      const auto step = static_cast<double>(i);
      silent = is_zero(step * stage->step) && (i == count || is_zero((step + of_a_step) * stage->step));
    }
    if (silent)
      said.push_back(
          fmt::format("the load \"{}\" is zero during all {} of the dynamic stages: the times of its function count from their beginning, "
                      "or it is zero everywhere",
                      time_load->name, format_quantity(duration, "s")));
  }
}

/// Bases without mass follow the loads in balance; the trapezoidal rule gives them velocities that alternate.
void warn_massless(const BuiltCase& built, std::vector<std::string>& said) {
  const Model& model = built.model;
  if (!dynamic_stage(built.plan)) return;
  std::string names;
  const Vector mass = diagonal_of(model, &Model::mass);
  for (int i = 0; i < model.free(); ++i) {
    const int node = model.space.node_of(model.kept[static_cast<std::size_t>(i)]);
    if (mass[i] != 0) continue;
    const bool base = std::ranges::any_of(
        built.facts, [&](const InterfaceFacts& facts) { return std::ranges::find(facts.upper, node) != facts.upper.end(); });
    if (base && names.size() < 60) names += (names.empty() ? "" : ", ") + model.unknown_name(i);
  }
  if (!names.empty())
    said.push_back(fmt::format(
        "no mass at {}: displacements and forces are those of the balance, but velocities, accelerations and floor spectra mean "
        "nothing there, and without contact nothing may determine the motion; give it a mass",
        names));
}

/// A static stage knows no velocities.
void warn_stop(const BuiltCase& built, std::vector<std::string>& said) {
  for (const std::size_t k : stopping_stages(built.plan))
    said.push_back(
        fmt::format("stage {} is static after a dynamic one: the structure is stopped there, and the energy that this takes is booked as "
                    "energy.stop",
                    k + 1));
}

/// Ten steps a period, as for any response by steps; and the shocks of rigid ground.
void warn_floors(const RunSpec& spec, const BuiltCase& built, std::vector<std::string>& said) {
  const Stage* stage = dynamic_stage(built.plan);
  if (!stage || built.plan.floors.empty()) return;
  if (built.plan.method->constrains() && !spec.bonded)
    said.push_back(fmt::format("floor spectra of a run with constraints: {}", floors_of_constraints));
  double highest = 0;
  for (const FloorRequest& floor : built.plan.floors) highest = std::max(highest, floor.frequencies.back());
  if (const double resolved = 1 / (10 * stage->step); resolved < highest)
    said.push_back(fmt::format("floor spectra up to {:.3g} Hz with a step of {}: ten steps a period reach up to {:.3g} Hz", highest,
                               format_quantity(stage->step, "s"), resolved));
  double lowest = highest, duration = 0;
  for (const FloorRequest& floor : built.plan.floors) lowest = std::min(lowest, floor.frequencies.front());
  for (const Stage& each : built.plan.stages) duration += each.type == Stage::Type::dynamics ? each.duration : 0;
  if (lowest * duration < 1)
    said.push_back(
        fmt::format("floor spectra down to {:.3g} Hz of a run of {}: an oscillator below {:.3g} Hz has not completed a cycle at its end, "
                    "and its largest response may follow later",
                    lowest, format_quantity(duration, "s"), 1 / duration));
}

void warn_method(const Case& read, const RunSpec& spec, const BuiltCase& built, std::vector<std::string>& said) {
  const Stage* stage = dynamic_stage(built.plan);
  if (!stage || spec.bonded) return;
  const Values* given = spec.impact ? spec.impact : read.input->impact;
  const std::string impact = given ? given->type() : built.plan.method->constrains() ? "project_hold" : "none";
  if (built.plan.method->constrains()) {
    if (impact == "none")
      said.push_back("constraints without a velocity correction (impact = \"none\") create energy without bound; take \"project_hold\"");
    if (impact == "reflect" || impact == "propagate")
      said.push_back(
          fmt::format("impact = \"{}\" corrects the velocity at every step: the multipliers alone are not the contact force", impact));
    if (spec.path_average.value_or(false))
      said.push_back("traction = \"path\" has no effect with a constraint method: it takes the force at the end of the step");
  } else if (!stage->path_average && impact == "none") {
    double largest = 0;
    for (const StiffnessRatio& ratio : stiffness_ratios(built.model, *stage, *built.plan.solver)) largest = std::max(largest, ratio.most);
    if (largest > 0.05)
      said.push_back(fmt::format(
          "traction at the end of the step with a stiff joint (k F_ii = {:.3g}): this creates energy; take {}, or an "
          "impact rule",
          largest,
          stage->scheme.average_acceleration() ? "traction = \"path\""
                                               : "scheme = \"average_acceleration\", which has the path average of the traction"));
  }
}

/// Cells side by side that do not share the side between them: the mesh is open there, unseen. Cells that planes cut have copies at their
/// place.
void warn_torn(const Case& read, const BuiltCase& built, std::vector<std::string>& said) {
  if (!read.mesh || std::ranges::any_of(read.mesh->cut, [](const auto& faces) { return !faces.empty(); })) return;
  const Mesh& mesh = read.mesh->mesh;
  const int first = static_cast<int>(read.input->nodes.size());  // those of the mesh follow the nodes of the case
  std::vector<int> joined;
  for (const InterfaceFacts& facts : built.facts)
    for (const std::vector<int>* side : {&facts.upper, &facts.lower})
      for (const int node : *side)
        if (node >= first && node - first < static_cast<int>(mesh.nodes.size())) joined.push_back(node - first);
  const std::vector<Vec3> torn = torn_sides(mesh, read.mesh->open, joined);
  if (torn.empty()) return;
  const Vec3& place = torn.front();
  said.push_back(fmt::format(
      "the mesh is torn: cells lie side by side and do not share the sides between them, at {} {}, as at ({:.6g}, {:.6g}, "
      "{:.6g}) m; merge nodes that are there twice, let cells side by side match (in degree and size, and no face of four corners "
      "beside triangles), or make an [[interface]] of it",
      torn.size(), torn.size() == 1 ? "side" : "sides", place.x(), place.y(), place.z()));
}

/// Solids hold no rotation: a column that ends at one of their nodes is hinged, which few mean.
void warn_hinges(const BuiltCase& built, std::vector<std::string>& said) {
  if (const std::vector<int> hinged = hinges(built.model); !hinged.empty())
    said.push_back(fmt::format(
        "beams end in hinges of solids, which hold no rotation: {}; where they are to be clamped, let them run on along edges of "
        "the solids, or take a [[rigid]] group",
        named_places(built.model, hinged)));
}

/// Between its nodes in the solids a beam bends as on hinged supports.
void warn_embedded_feet(const BuiltCase& built, std::vector<std::string>& said) {
  const std::vector<EmbeddedFoot> feet = embedded_feet(built.model);
  if (feet.empty()) return;
  const auto softer = [](const EmbeddedFoot& foot) { return 3 * foot.flexibility / foot.free_length; };
  const EmbeddedFoot& worst = *std::ranges::max_element(feet, {}, softer);
  said.push_back(fmt::format(
      "{} run on into solids, along {} of {} at {}: that foot turns by {:.3g} m x M/(E I) more than a clamped one, so that a cantilever of "
      "its free length, {}, moves {} further; a [[rigid]] plate under the foot clamps it, and smaller cells reduce the error in proportion",
      feet.size() == 1 ? "a beam" : fmt::format("{} beams", feet.size()),
      worst.cells == 1 ? "one cell" : fmt::format("{} cells", worst.cells), format_quantity(worst.cell, "m"),
      named_places(built.model, {worst.node}), worst.flexibility, format_quantity(worst.free_length, "m"), percent(softer(worst))));
}

}  // namespace

std::vector<std::string> warnings(const Case& read, const RunSpec& spec, const BuiltCase& built) {
  std::vector<std::string> said;
  warn_magnitudes(read, said);
  warn_input(read, spec, built, said);
  warn_massless_beams(read, said);
  warn_interfaces(read, built, said);
  warn_idle_functions(read, built, said);
  warn_p_delta(read, built, said);
  warn_sudden_weight(built, said);
  warn_no_excitation(built, said);
  warn_repetitions(*read.input, said);
  warn_ground_and_wave(*read.input, said);
  warn_duration(built, said);
  warn_sides(read, said);
  warn_held_faces(read, built, said);
  warn_torn(read, built, said);
  warn_hinges(built, said);
  warn_embedded_feet(built, said);
  warn_step(built, said);
  warn_loads(built, said);
  warn_silent_loads(built, said);
  warn_massless(built, said);
  warn_stop(built, said);
  warn_floors(spec, built, said);
  warn_method(read, spec, built, said);
  warn_content(read, built, said);
  warn_motions(built.motions, built.plan.stages, said);
  return said;
}

}  // namespace uplift
