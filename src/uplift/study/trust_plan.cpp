#include "uplift/study/trust_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/case/build/bed.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/contact/method.h"
#include "uplift/laws/tangential.h"
#include "uplift/mesh/placed_cell.h"

namespace uplift {
namespace {

constexpr double least_tolerance = 1e-13;  // below, round-off decides
constexpr double of_joint = 10;            // the stiffness of a joint is a choice of the computation, which should not matter
constexpr double of_soil = 2;              // that of the soil is a property, which is hardly known better than within this factor

bool has_number(const Values& part, std::string_view key) {
  return part.items().contains(key) && part.has(key);
}

/// With the numbers of its soil.
Values law_of(const CaseInterface& interface) {
  const CaseFooting* footing = interface.footing();
  const auto soil = footing ? soil_of(*footing) : nullptr;
  const auto numbers = law_on_soil(*interface.law, soil.get(), footing && footing->length ? 3 : 2);
  return numbers ? *numbers : *interface.law;
}

std::string law_path(std::size_t interface) {
  return fmt::format("interface[{}].law", interface);
}

bool is_cone(const Values& law) {
  return std::ranges::any_of(cone_catalog(), [&](const Entry<Cone>* entry) { return entry->name == law.type(); });
}

/// The contact method that a run of the case takes.
Values method_values(const Case& read) {
  const Values& root = read.values;
  if (read.input->method) return *read.input->method;
  const bool cones = std::ranges::any_of(read.input->interfaces, [](const CaseInterface& each) { return is_cone(*each.law); });
  return check_part(Raw{std::string(standard_method(cones)), root.where(), "method"}, contact_methods());
}

/// Numbers of a law that are stiffnesses, by their unit.
std::vector<std::string_view> stiffness_keys(const Values& law) {
  std::vector<std::string_view> keys;
  for (const Field& field : law.part_info()->params)
    if (field.unit == "Pa/m" && has_number(law, field.name)) keys.push_back(field.name);
  return keys;
}

bool has_parameter(const PartInfo& part, std::string_view key) {
  return std::ranges::find(part.params, key, &Field::name) != part.params.end();
}

bool is_parameter_of(std::string_view law, std::string_view key) {
  return has_parameter(**std::ranges::find(interface_behaviours(), law, &PartInfo::name), key);
}

/// The edits that put another law, which has the same answer, in the place of one.
std::vector<CaseEdit> replaced(const std::string& path, const Values& law, const EquivalentLaw& other) {
  std::vector<CaseEdit> edits{{path, std::string(other.name)}};
  for (const auto& [key, value] : other.parameters) edits.push_back({fmt::format("{}.{}", path, key), value});
  for (const Field& field : law.part_info()->params)
    if (field.kind == Kind::number && has_number(law, field.name) && is_parameter_of(other.name, field.name))
      edits.push_back({fmt::format("{}.{}", path, field.name), law.number(field.name)});
  edits.push_back({path + ".tangential", tangential_kind(law)});
  return edits;
}

class Planner {
 public:
  explicit Planner(const Case& read) : input_(*read.input), mesh_(read.mesh.get()), trust_(input_.trust), method_(method_values(read)) {}

  TrustPlan plan() {
    halve_step();
    if (input_.interfaces.empty()) {
      leave_out("interface", input_.foundations.empty()
                                 ? "the case has no interface"
                                 : "a foundation has the stiffness of its ground, which the computation does not choose");
    } else {
      change_stiffness();
      add_points();
      tighten();
      change_method();
    }
    refine();
    move_mesh();
    return std::move(plan_);
  }

 private:
  void add(std::string name, std::string choice, std::string label, std::vector<CaseEdit> edits) {
    plan_.changes.push_back({std::move(name), std::move(choice), std::move(label), std::move(edits)});
  }
  void leave_out(std::string choice, std::string reason) { plan_.left_out.push_back({std::move(choice), std::move(reason)}); }

  void halve_step() {
    std::vector<CaseEdit> edits;
    double smallest = 0;
    const std::vector<CaseStage>& stages = input_.stages;
    for (std::size_t i = 0; i < stages.size(); ++i) {
      if (!stages[i].step) continue;
      const double half = *stages[i].step / 2;
      smallest = edits.empty() ? half : std::min(smallest, half);
      edits.push_back({fmt::format("stage[{}].step", i), half});
    }
    if (edits.empty()) return leave_out("time step", "the case has no dynamic stage");
    // columns keep their instants
    edits.push_back({"output.every", std::int64_t{2} * input_.output.every});
    add("step_half", "time step", fmt::format("half the time step, {:g} ms", 1e3 * smallest), std::move(edits));
  }

  /// A law of a footing on fixed ground is the soil itself.
  double factor_of(const CaseInterface& interface) const {
    if (trust_.stiffness_factor) return *trust_.stiffness_factor;
    return interface.footing() && !interface.footing()->bed ? of_soil : of_joint;
  }

  /// The ends of the sweep, then what lies between an end and the case.
  void change_stiffness() {
    if (trust_.stiffness_factor == 1.0) return leave_out(std::string(joint_stiffness), "stiffness_factor = 1");
    const long parts = trust_.interior + 1;
    for (long part = parts; part > 0; --part)
      for (const bool stiffer : {true, false}) {
        const std::string suffix = part == parts ? "" : fmt::format("_{}", part);
        const double power = static_cast<double>(part) / static_cast<double>(parts);
        if (!change_stiffness((stiffer ? "stiffer" : "softer") + suffix, stiffer, power)) return;
      }
  }

  /// `power` of the factors: 1 at the ends. False where nothing has a stiffness.
  bool change_stiffness(std::string name, bool stiffer, double power) {
    std::vector<CaseEdit> edits;
    std::vector<double> factors;
    std::string refusal;
    const auto add_factor = [&](double factor) { return factors.emplace_back(std::pow(factor, power)); };
    const std::vector<CaseInterface>& interfaces = input_.interfaces;
    for (std::size_t k = 0; k < interfaces.size(); ++k) {
      const Values law = law_of(interfaces[k]);
      const std::vector<std::string_view> keys = stiffness_keys(law);
      if (keys.empty()) continue;
      const double factor = add_factor(factor_of(interfaces[k])), by = stiffer ? factor : 1 / factor;
      for (const std::string_view key : keys) edits.push_back({fmt::format("{}.{}", law_path(k), key), by * law.number(key)});
      if (const auto made = make_part(law_catalog(), law); made != nullptr && !stiffer) {
        double stiffness[3] = {};
        made->closed_stiffness(3, stiffness);
        if (const double least = made->scales().least_stiffness; by * stiffness[2] <= least)
          refusal = fmt::format("the law of '{}' needs a stiffness above {:.3g} Pa/m", interfaces[k].name.name, least);
      }
    }
    if (regularises()) {
      const char* key = has_number(method_, "stiffness") ? "stiffness" : "factor";
      const double factor = add_factor(trust_.stiffness_factor.value_or(of_joint));
      edits.push_back({std::string("method.") + key, (stiffer ? factor : 1 / factor) * method_.number(key)});
    }
    if (edits.empty()) {
      leave_out(std::string(joint_stiffness), "constraints are rigid");
      return false;
    }
    const auto [least, most] = std::ranges::minmax(factors);
    const std::string times = least == most ? fmt::format("{:.4g}", most) : fmt::format("{:.4g} or {:.4g}", least, most);
    if (!refusal.empty())
      leave_out(fmt::format("{}, {}", joint_stiffness, power == 1 ? "softer" : times + " times as soft"), refusal);
    else
      add(std::move(name), std::string(joint_stiffness), fmt::format("joint {} times as {}", times, stiffer ? "stiff" : "soft"),
          std::move(edits));
    return true;
  }

  /// Every strip between the points of a footing is halved.
  void add_points() {
    std::vector<CaseEdit> edits;
    std::string label;
    const std::vector<CaseInterface>& interfaces = input_.interfaces;
    for (std::size_t k = 0; k < interfaces.size(); ++k) {
      const CaseFooting* footing = interfaces[k].footing();
      if (!footing) continue;
      const bool on_edges = footing->rule == FootingRule::nodal;
      const auto refine = [&](const char* key, std::int64_t points) {
        const std::int64_t finer = on_edges && points > 1 ? 2 * points - 1 : 2 * points;
        edits.push_back({fmt::format("interface[{}].footing.{}", k, key), finer});
        label += fmt::format("{}{} instead of {}", label.empty() ? "" : ", ", finer, points);
      };
      refine("points", footing->points);
      if (footing->points_across) refine("points_across", *footing->points_across);
    }
    if (edits.empty()) return leave_out("points of the footing", "no interface is a footing");
    add("more_points", "points of the footing", label + " points", std::move(edits));
  }

  void tighten() {
    std::vector<CaseEdit> edits;
    const auto tighter = [&](const char* key) { return std::max(least_tolerance, 0.1 * method_.number(key)); };
    const double tolerance = tighter("tolerance");
    if (!input_.method) edits.push_back({"method", method_.type()});
    edits.push_back({"method.tolerance", tolerance});
    if (has_number(method_, "gap_tolerance")) edits.push_back({"method.gap_tolerance", tighter("gap_tolerance")});
    if (const std::optional<double>& gap = input_.limits.gap_tolerance) edits.push_back({"limits.gap_tolerance", 0.1 * *gap});
    add("tighter", "tolerance", fmt::format("tolerance {:g}", tolerance), std::move(edits));
  }

  /// Another way to the same answer: constraints by another method; another law that is equivalent; and where one of the laws has none, the
  /// dissipative scheme with the traction at the end of the step.
  void change_method() {
    if (constrains() || regularises()) {
      const std::string other(other_exact_method(method_.type()));
      return add("other_method", "method", other + " instead of " + method_.type(), {{"method", other}});
    }
    std::vector<CaseEdit> edits;
    const std::vector<CaseInterface>& interfaces = input_.interfaces;
    std::string label;
    for (std::size_t k = 0; k < interfaces.size(); ++k) {
      const Values law = law_of(interfaces[k]);
      const auto made = make_part(law_catalog(), law);
      const auto other = made ? made->equivalent() : std::nullopt;
      if (!other) return change_scheme();
      std::ranges::move(replaced(law_path(k), law, *other), std::back_inserter(edits));
      label = fmt::format("{} instead of {}", other->name, law.type());
    }
    add("other_law", "method", label, std::move(edits));
  }

  void change_scheme() {
    std::vector<CaseEdit> edits;
    const std::vector<CaseStage>& stages = input_.stages;
    for (std::size_t i = 0; i < stages.size(); ++i) {
      if (stages[i].statics) continue;
      if (stages[i].scheme->type() == "generalised_alpha")
        return leave_out("method", "no other sound method is known for these laws and this scheme");
      edits.push_back({fmt::format("stage[{}].scheme", i), std::string("generalised_alpha")});
      edits.push_back({fmt::format("stage[{}].traction", i), std::string("end")});
    }
    if (edits.empty()) return leave_out("method", "the case has no dynamic stage");
    add("other_scheme", "method", "generalised-alpha, end-of-step traction", std::move(edits));
  }

  void refine() {
    const double factor = trust_.mesh_factor;
    if (!input_.mesh || !input_.mesh->soil_box) return leave_out("mesh", input_.mesh ? "the mesh is a file" : "the case has no mesh");
    if (factor == 1) return leave_out("mesh", "mesh_factor = 1");
    if (constrains_along_simplices()) return leave_out("mesh", no_constraints_across);
    const SoilBox& box = *input_.mesh->soil_box;
    std::vector<CaseEdit> edits;
    const std::string path = "mesh.soil_box.";
    edits.push_back({path + "soil.size", factor * box.soil.size});
    const std::vector<SoilBox::Layer>& layers = box.soil.layers;
    for (std::size_t i = 0; i < layers.size(); ++i)
      edits.push_back({fmt::format("{}soil.layers[{}].size", path, i), factor * layers[i].size});
    if (box.raft.height > 0) edits.push_back({path + "raft.size", factor * box.raft.size});
    if (box.block.height > 0) edits.push_back({path + "block.size", factor * box.block.size});
    add("finer", "mesh", fmt::format("elements {:g} times as large", factor), std::move(edits));
  }

  /// Planes that the mesh ignores: the mesh is moved beside them.
  void move_mesh() {
    const double share = trust_.mesh_shift;
    const std::vector<CaseInterface>& interfaces = input_.interfaces;
    if (std::ranges::none_of(interfaces, [](const CaseInterface& each) { return each.cut() != nullptr; })) return;
    if (share == 0) return leave_out("place of the mesh", "mesh_shift = 0");
    if (constrains_along_simplices()) return leave_out("place of the mesh", no_constraints_across);
    for (const double by : {share, -share}) {
      std::vector<CaseEdit> edits;
      for (std::size_t k = 0; k < interfaces.size(); ++k)
        if (const CaseCut* cut = interfaces[k].cut())
          edits.push_back({fmt::format("interface[{}].cut.mesh_shift", k), std::clamp(cut->mesh_shift + by, -0.45, 0.45)});
      add(by > 0 ? "mesh_forth" : "mesh_back", "place of the mesh",
          fmt::format("mesh moved {:g} of a cell {} the normal of the cut", share, by > 0 ? "along" : "against"), std::move(edits));
    }
  }

  bool constrains() const { return make_part(method_catalog(), method_)->constrains(); }
  /// Constraints on a plane along faces of triangles or tetrahedra: in another mesh it passes through them, where constraints are refused.
  bool constrains_along_simplices() const {
    if (mesh_ == nullptr || !constrains()) return false;
    return std::ranges::any_of(mesh_->cut, [&](const std::vector<CutFace>& faces) {
      return std::ranges::any_of(faces, [&](const CutFace& face) { return is_simplex(mesh_->mesh.type(face.upper)); });
    });
  }
  /// The method has a stiffness of its own in the place of constraints.
  bool regularises() const { return has_parameter(*method_.part_info(), "stiffness"); }

  static constexpr const char* no_constraints_across =
      "constraints are refused where the plane passes through triangles or tetrahedra; a traction law can tell";

  const CaseInput& input_;
  const CaseMesh* mesh_;
  const CaseTrust& trust_;
  const Values method_;
  TrustPlan plan_;
};

}  // namespace

TrustPlan trust_plan(const Case& read) {
  return Planner(read).plan();
}

}  // namespace uplift
