#pragma once
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "uplift/dynamics/scheme.h"
#include "uplift/elements/beam.h"
#include "uplift/elements/discrete.h"
#include "uplift/laws/tangential.h"
#include "uplift/linear/solver.h"
#include "uplift/model/builder.h"
#include "uplift/run/run.h"

// Models and plans of whole runs, made without a case file: what the oracle, energy, robustness and counter tests share.
namespace uplift::whole {

inline const Where here{"case.toml", 1};

/// A part by name with its parameters, as in a case file.
struct Part {
  std::string type;
  std::vector<std::pair<std::string, std::variant<double, std::string>>> parameters = {};
};

inline Values checked(const Part& part, std::span<const PartInfo* const> catalog) {
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("type", Raw{part.type, here, "type"});
  for (const auto& [key, value] : part.parameters) {
    Raw raw{{}, here, key};
    if (const double* number = std::get_if<double>(&value))
      raw.data = *number;
    else
      raw.data = std::get<std::string>(value);
    table->entries.emplace_back(key, raw);
  }
  return check_part(Raw{table, here, "part"}, catalog);
}

inline Scheme scheme(const Part& part) {
  return *make_part(scheme_catalog(), checked(part, schemes()));
}
inline std::shared_ptr<const TimeFunction> function(const Part& part) {
  return make_part(function_catalog(), checked(part, time_functions()));
}

/// Everything that a run needs, owned.
struct Whole {
  Model model;
  RunPlan plan;
  std::vector<std::unique_ptr<const Values>> behaviours;
  std::vector<const Values*> parameters() const {
    std::vector<const Values*> pointers;
    for (const auto& values : behaviours) pointers.push_back(values.get());
    return pointers;
  }
  RunResult run() const { return uplift::run(model, plan, parameters()); }
};

/// False where the first interface is bonded: it has no gap, however far it is stretched.
inline bool opens(const Whole& whole) {
  const InterfaceLaw* law = whole.model.interfaces.front().law.get();
  return law == nullptr || law->scales().opens;
}

/// Puts a law or a cone on an interface.
inline void behave(const Part& part, InterfaceSpec& spec, Whole& whole) {
  auto values = std::make_unique<const Values>(checked(part, interface_behaviours()));
  const bool shear = values->items().contains("tangential") ? tangential_kind(*values) != "none" : part.type == "coulomb";
  spec.components = shear ? 2 : 1;
  spec.behaviour = part.type;
  spec.law = make_part(law_catalog(), *values);
  if (spec.law == nullptr) spec.cone = make_part(cone_catalog(), *values);
  whole.behaviours.push_back(std::move(values));
}

inline void choose(Whole& whole, const Part& method, const Part& impact) {
  whole.plan.method = make_part(method_catalog(), checked(method, contact_methods()));
  whole.plan.impact = make_part(impact_catalog(), checked(impact, impact_rules()));
  if (whole.plan.solver == nullptr) whole.plan.solver = make_part(solver_catalog(), checked({"cholmod"}, linear_solvers()));
}

inline Request request(Request::Kind kind, int index, std::string name) {
  Request made;
  made.kind = kind;
  made.name = std::move(name);
  made.unit = "SI";
  made.unknown = index;
  made.interface = index;
  return made;
}

/// Displacement and velocity of every node, resultants of every interface, all energies.
inline void watch_all(Whole& whole) {
  using Kind = Request::Kind;
  std::vector<Request>& list = whole.plan.requests;
  for (int i = 0; i < whole.model.full_unknowns(); ++i) {
    list.push_back(request(Kind::displacement, i, "u" + std::to_string(i)));
    list.push_back(request(Kind::velocity, i, "v" + std::to_string(i)));
  }
  for (int i = 0; i < static_cast<int>(whole.model.interfaces.size()); ++i)
    for (const Kind kind : {Kind::axial, Kind::shear, Kind::moment, Kind::max_opening, Kind::uplifted_ratio})
      list.push_back(request(kind, i, "resultant"));
  for (const Kind kind :
       {Kind::kinetic, Kind::strain, Kind::stored, Kind::interface_dissipated, Kind::damping, Kind::impact, Kind::external, Kind::residual})
    list.push_back(request(kind, 0, "energy"));
}

/// The reference oscillator of tests/verification/oscillator_test.cpp; its numbers may be changed.
struct Oscillator {
  double height = 5, half_width = 1.5, bending = 4e9;  // m, m, N m2
  double mass = 24317.0841, base_mass = 1e4, base_inertia = 7500;
  double vertical = 1e6, push = 3e5, duration = 0.1;  // N, N, s: half-sine at the top
  int points = 11;
  bool slides = false;  // the base is free horizontally
  double damping = 0;   // ratio at 2 Hz and 10 Hz
  Part behaviour;
};

inline Whole make(const Oscillator& data) {
  Whole whole;
  ModelBuilder builder;
  const int base = builder.add_node("base", {0, 0}, here), top = builder.add_node("top", {0, data.height}, here);
  BeamSection section;
  section.bending = data.bending;
  builder.add_element(std::make_unique<Beam>(base, top, Vec2{0, 0}, Vec2{0, data.height}, section), here);
  builder.inextensible(base, top, here);
  builder.add_element(std::make_unique<PointMass>(top, data.mass, 0.0), here);
  builder.add_element(std::make_unique<PointMass>(base, data.base_mass, data.base_inertia), here);
  if (!data.slides) builder.fix(base, ux, here);
  builder.add_load("weight", {{3 * top + 1, -data.vertical}}, nullptr, true, here);
  if (data.push != 0) builder.add_load("push", {{3 * top, data.push}}, function({"half_sine", {{"duration", data.duration}}}), false, here);
  InterfaceSpec spec;
  spec.name = "footing";
  Footing footing;
  footing.body = base;
  footing.width = 2 * data.half_width;
  footing.points = data.points;
  spec.points = footing_points(footing, here);
  behave(data.behaviour, spec, whole);
  builder.add_interface(std::move(spec), here);
  if (data.damping > 0) builder.set_damping(rayleigh(2, data.damping, 10, data.damping));
  whole.model = builder.finish();
  return whole;
}

/// A straight beam of equal elements along x at height y; returns its nodes.
inline std::vector<int> add_beam_line(ModelBuilder& builder, const std::string& name, double x0, double x1, double y, int elements,
                                      const BeamSection& section) {
  std::vector<int> nodes;
  const auto place = [&](int i) { return Vec2{x0 + (x1 - x0) * i / elements, y}; };
  for (int i = 0; i <= elements; ++i) nodes.push_back(builder.add_node(name + std::to_string(i), place(i), here));
  for (int i = 0; i < elements; ++i)
    builder.add_element(
        std::make_unique<Beam>(nodes[static_cast<std::size_t>(i)], nodes[static_cast<std::size_t>(i) + 1], place(i), place(i + 1), section),
        here);
  return nodes;
}

inline BeamSection concrete_beam() {
  BeamSection section;
  section.bending = 5e7;  // E I of a section 0.3 m x 0.3 m and more
  section.axial = 3e9;
  section.mass = BeamSection::Mass::consistent;
  section.mass_per_length = 250;
  return section;
}

/// A beam of 6 m resting on ground at its two ends, three node pairs each, pushed up in the middle: both ends leave the ground.
struct Bridge {
  Part left, right;
  int elements = 10;
  double push = 6e4, weight = 3e3;  // N per node and in the middle
  double damping = 0;
};

inline Whole make(const Bridge& data) {
  Whole whole;
  ModelBuilder builder;
  const std::vector<int> nodes = add_beam_line(builder, "n", 0, 6, 0, data.elements, concrete_beam());
  const auto place = [&](int i) { return Vec2{6.0 * i / data.elements, 0}; };
  std::vector<std::pair<int, double>> weight;
  for (const int node : nodes) weight.emplace_back(3 * node + 1, -data.weight);
  builder.add_load("weight", weight, nullptr, true, here);
  const int middle = nodes[nodes.size() / 2];
  builder.add_load("push", {{3 * middle + 1, data.push}, {3 * nodes.front() + 1, 0.1 * data.push}, {3 * middle, 0.2 * data.push}},
                   function({"harmonic", {{"frequency", 9.0}, {"end", 0.4}}}), false, here);
  for (const bool first : {true, false}) {
    InterfaceSpec spec;
    spec.name = first ? "left" : "right";
    std::vector<SideNode> side;
    for (int k = 0; k < 3; ++k) {
      const int i = first ? k : data.elements - 2 + k;
      side.push_back({nodes[static_cast<std::size_t>(i)], place(i)});
    }
    spec.points = pair_points(side, {}, Vec2::UnitY(), 0.09, 0, Space{2}, here);
    behave(first ? data.left : data.right, spec, whole);
    builder.add_interface(std::move(spec), here);
  }
  // soft horizontal spring: nothing else holds the beam sideways where the joints carry no shear
  builder.add_element(std::make_unique<Spring>(Connection{{nodes.front()}, Vec2{1, 0}}, 2e6), here);
  if (data.damping > 0) builder.set_damping(rayleigh(5, data.damping, 60, data.damping));
  whole.model = builder.finish();
  return whole;
}

/// Two beams one upon the other, tied by node pairs only: the lower one clamped at both ends, the upper one lies on it.
struct Leaves {
  Part behaviour;
  int elements = 6;
  double push = 3e4, weight = 3e3;
};

inline Whole make(const Leaves& data) {
  Whole whole;
  ModelBuilder builder;
  const std::vector<int> lower = add_beam_line(builder, "low", 0, 4, 0, data.elements, concrete_beam());
  const std::vector<int> upper = add_beam_line(builder, "up", 0, 4, 0, data.elements, concrete_beam());
  for (const int node : {lower.front(), lower.back()})
    for (const Dof dof : {ux, uy, rz}) builder.fix(node, dof, here);
  std::vector<std::pair<int, double>> weight;
  for (const int node : upper) weight.emplace_back(3 * node + 1, -data.weight);
  builder.add_load("weight", weight, nullptr, true, here);
  builder.add_load("push", {{3 * upper[2] + 1, data.push}, {3 * upper[4], 0.3 * data.push}},
                   function({"harmonic", {{"frequency", 12.0}, {"end", 0.3}}}), false, here);
  builder.add_element(std::make_unique<Spring>(Connection{{upper.front()}, Vec2{1, 0}}, 2e6), here);
  std::vector<SideNode> above, below;
  for (std::size_t i = 0; i < upper.size(); ++i) {
    const Vec2 place{4.0 * static_cast<double>(i) / data.elements, 0};
    above.push_back({upper[i], place});
    below.push_back({lower[i], place});
  }
  InterfaceSpec spec;
  spec.name = "leaf";
  spec.points = pair_points(above, below, Vec2::UnitY(), 0.1, 0, Space{2}, here);
  behave(data.behaviour, spec, whole);
  builder.add_interface(std::move(spec), here);
  whole.model = builder.finish();
  return whole;
}

inline Stage settle(int steps = 5) {
  Stage stage;
  stage.type = Stage::Type::statics;
  stage.steps = steps;
  return stage;
}

inline Stage march(double step, long steps, bool path_average = true, const Part& rule = {"average_acceleration"}) {
  Stage stage;
  stage.type = Stage::Type::dynamics;
  stage.step = step;
  stage.duration = step * static_cast<double>(steps);
  stage.scheme = scheme(rule);
  stage.path_average = path_average;
  return stage;
}

}  // namespace uplift::whole
