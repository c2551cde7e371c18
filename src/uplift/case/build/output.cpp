#include "uplift/case/build/output.h"

#include <fmt/format.h>

#include <algorithm>

#include "uplift/base/text.h"
#include "uplift/case/build/forces.h"
#include "uplift/case/build/model.h"
#include "uplift/dynamics/plastic_bulk.h"
#include "uplift/interface/shear.h"
#include "uplift/laws/stated.h"
#include "uplift/run/quantities.h"

namespace uplift {
namespace {

using Column = Request::Kind;

struct NodeQuantity {
  std::string word;
  Column kind;
  int index;  // of the unknown among those of its node
  std::string unit;
};

/// Displacements "ux", velocities "vx" and accelerations "ax"; of rotations "rz", "vrz", "arz"; absolute accelerations "abs_ax".
std::vector<NodeQuantity> node_quantities(Space space) {
  std::vector<NodeQuantity> made;
  const std::pair<const char*, Column> kinds[] = {{"", Column::displacement}, {"v", Column::velocity}, {"a", Column::acceleration}};
  const char* per[] = {"", "/s", "/s2"};
  for (int order = 0; order < 3; ++order)
    for (int i = 0; i < space.unknowns(); ++i) {
      const std::string name(to_string(space.dof(i)));
      const bool turns = space.is_rotation(i);
      const std::string word = order == 0 ? name : kinds[order].first + (turns ? name : name.substr(1));
      made.push_back({word, kinds[order].second, i, std::string(turns ? "rad" : "m") + per[order]});
    }
  for (int i = 0; i < space.dimension; ++i)
    made.push_back({fmt::format("abs_a{}", to_string(space.dof(i)).substr(1)), Column::absolute_acceleration, i, "m/s2"});
  return made;
}

/// The numbers that an interface has. A whole foundation has forces, no pressures.
std::vector<InterfaceQuantity> quantities_of(const Interface& interface, const Values& behaviour) {
  const StatedNumbers stated = interface.footprint ? stated_numbers(behaviour) : StatedNumbers();
  const auto has = [&](InterfaceQuantity::Needs needed) {
    switch (needed) {
      case InterfaceQuantity::Needs::nothing:
        return true;
      case InterfaceQuantity::Needs::points:
        return !interface.footprint;
      case InterfaceQuantity::Needs::dashpots:
        return interface.footprint && !radiation_damping(*interface.footprint).empty();
      case InterfaceQuantity::Needs::bearing_strength:
        return stated.service.has_value();
      case InterfaceQuantity::Needs::growing_strength:
        return stated.service && stated.ultimate && *stated.ultimate > *stated.service;
      case InterfaceQuantity::Needs::friction:
        return stated.friction_angle.has_value();
    }
    return false;
  };
  std::vector<InterfaceQuantity> made;
  for (const InterfaceQuantity& each : interface_quantities())
    if ((each.dimension == 0 || each.dimension == interface.space.dimension) && has(each.needs)) made.push_back(each);
  return made;
}
/// The law of an interface, or the model of a foundation, as the case states it: that of a bonded run is another one.
const Values& stated_behaviour(const Case& read, const BuiltCase& built, std::size_t interface) {
  for (const CaseFoundation& foundation : read.input->foundations)
    if (foundation.name.name == built.model.interfaces[interface].name) return *foundation.model;
  return *built.behaviours[interface];
}
/// Whether a run has this quantity of an interface; a bonded one has no strength.
bool has_quantity(const BuiltCase& built, const Request& request) {
  const auto k = static_cast<std::size_t>(request.interface);
  if (request.kind != Column::bearing_utilisation && request.kind != Column::bearing_capacity &&
      request.kind != Column::sliding_utilisation)
    return true;
  const std::vector<InterfaceQuantity> all = quantities_of(built.model.interfaces[k], *built.behaviours[k]);
  return std::ranges::find(all, request.kind, &InterfaceQuantity::kind) != all.end();
}
/// Those that need a tangential part of the interface.
bool is_shear(Column kind) {
  return kind == Column::shear || kind == Column::shear_1 || kind == Column::shear_2 || kind == Column::torsion;
}

/// Energies of what a run has not are left out.
bool has_energy(const BuiltCase& built, Column kind) {
  const auto filters = [](const Stage& stage) { return stage.type == Stage::Type::dynamics && stage.scheme.filtered(); };
  if (kind == Column::plastic) return PlasticBulk(built.model).any();
  if (kind == Column::stop) return !stopping_stages(built.plan).empty();
  if (kind == Column::algorithmic || kind == Column::filter)
    return !built.plan.method->constrains() && std::ranges::any_of(built.plan.stages, filters);
  return true;
}

struct PointQuantity {
  std::string word;
  Column kind;
  int tangent;  // number of the tangent; -1: normal
  std::string_view unit;
};

std::vector<PointQuantity> point_quantities(Space space) {
  std::vector<PointQuantity> made{{"opening", Column::opening, -1, "m"},
                                  {"traction", Column::traction, -1, "Pa"},
                                  {"mean_traction", Column::traction, -1, "Pa"},
                                  {"end_traction", Column::end_traction, -1, "Pa"}};
  for (int k = 0; k < space.dimension - 1; ++k) {
    const std::string number = space.dimension == 2 ? "" : fmt::format("_{}", k + 1);
    made.push_back({"slip" + number, Column::opening, k, "m"});
    made.push_back({"shear_traction" + number, Column::traction, k, "Pa"});
    made.push_back({"mean_shear_traction" + number, Column::traction, k, "Pa"});
    made.push_back({"end_shear_traction" + number, Column::end_traction, k, "Pa"});
  }
  return made;
}

/// The entry with this word; InputError with the list and the nearest word when there is none.
template <class Table>
auto find_quantity(const Table& table, const CaseHistory& history, std::string_view of) {
  const std::string& word = history.quantity.name;
  std::vector<std::string> words;
  for (const auto& entry : table) {
    if (entry.word == word) return entry;
    words.emplace_back(entry.word);
  }
  fail(history.quantity, fmt::format("a quantity of {}: {}", of, fmt::join(words, ", ")), "\"" + word + "\"", nearest_name(word, words));
}

Request make(Column kind, std::string name, std::string_view unit) {
  Request request;
  request.kind = kind;
  request.name = std::move(name);
  request.unit = unit;
  return request;
}

Request node_request(const Model& model, int node, const NodeQuantity& quantity, std::string name = {}) {
  if (name.empty()) name = fmt::format("{}.{}", model.nodes[node].name, quantity.word);
  Request request = make(quantity.kind, std::move(name), quantity.unit);
  request.unknown = model.space.unknowns() * node + quantity.index;
  return request;
}

void add_node(const Model& model, int node, std::vector<std::string_view> words, std::vector<Request>& requests) {
  for (const NodeQuantity& quantity : node_quantities(model.space))
    if (std::find(words.begin(), words.end(), quantity.word) != words.end() && moves(model, model.space.unknowns() * node + quantity.index))
      requests.push_back(node_request(model, node, quantity));
}

Request point_request(const CaseHistory& history, const Model& model, int interface, std::string name) {
  const Interface& joint = model.interfaces[interface];
  const int point = *history.point;
  if (point > joint.batch.points)
    fail(history, "point", fmt::format("a point of \"{}\", from 1 to {}", joint.name, joint.batch.points), fmt::format("{}", point));
  const PointQuantity quantity = find_quantity(point_quantities(model.space), history, "an interface point");
  if (quantity.tangent >= 0 && joint.batch.components == 1)
    fail(history.quantity, fmt::format("a normal quantity: \"{}\" has no tangential part", joint.name),
         "\"" + history.quantity.name + "\"");
  if (name.empty()) name = fmt::format("{}.{}.{}", joint.name, point, quantity.word);
  const bool force = joint.footprint && quantity.unit == "Pa";  // the point of a foundation stands for its whole area
  Request request = make(quantity.kind, std::move(name), force ? "N" : quantity.unit);
  request.interface = interface;
  request.point = point - 1;
  request.component = quantity.tangent < 0 ? joint.batch.translations() - 1 : quantity.tangent;
  return request;
}

/// The node nearest to a place; of nodes at the same place (the sides of an interface) the first, that of the lower side.
int nearest_node(const Place& place, const std::string& what, BuiltCase& built) {
  int nearest = -1;
  const auto distance = [&](int node) { return (built.model.nodes[static_cast<std::size_t>(node)].position - place).norm(); };
  for (int node = 0; node < static_cast<int>(built.model.nodes.size()); ++node)
    if (!built.bare.contains(node) && (nearest < 0 || distance(node) < distance(nearest) - 1e-9)) nearest = node;
  const Node& found = built.model.nodes[static_cast<std::size_t>(nearest)];
  built.notes.push_back(fmt::format("{} at {} m: node {} at {} m, {:.3g} m away", what, to_string(place, built.model.space), found.name,
                                    to_string(found.position, built.model.space), distance(nearest)));
  return nearest;
}

Request asked_request(const CaseHistory& history, const Case& read, BuiltCase& built, const CaseNames& names, const Names& interfaces) {
  const std::string name = history.name ? history.name->name : "";
  if (history.beam || history.level || history.group) return force_request(history, built, names);
  const int given = history.node.has_value() + history.at.has_value() + history.interface.has_value();
  if (given != 1)
    fail(history, "", "exactly one of node, at, interface, beam, level and group", given == 0 ? "none" : fmt::format("{}", given));
  if (!history.interface) {
    const int node = asked_node(history, history.quantity.name, built);
    if (history.below || is_constraint_force(history.quantity.name)) return force_request(history, built, names, node);
    return node_request(built.model, node, find_quantity(node_quantities(built.model.space), history, "a node"), name);
  }
  const int interface = interfaces.find(*history.interface);
  if (history.point) return point_request(history, built.model, interface, name);
  const Interface& joint = built.model.interfaces[interface];
  const std::string owner = joint.footprint ? "the foundation " + in_quotes(joint.name) : "an interface";
  const InterfaceQuantity quantity =
      find_quantity(quantities_of(joint, stated_behaviour(read, built, static_cast<std::size_t>(interface))), history, owner);
  Request request = make(quantity.kind, name.empty() ? fmt::format("{}.{}", joint.name, quantity.word) : name, quantity.unit);
  request.interface = interface;
  return request;
}

}  // namespace

bool moves(const Model& model, int full_unknown) {
  if (Sparse::InnerIterator(model.expansion, full_unknown)) return true;
  return std::any_of(model.motions.begin(), model.motions.end(),
                     [&](const PrescribedMotion& motion) { return motion.shape[full_unknown] != 0; });
}

int asked_node(const NodeAsked& asked, const std::string& what, BuiltCase& built) {
  if (asked.node.has_value() == asked.at.has_value()) fail(asked, "", "exactly one of node and at", asked.at ? "both" : "none");
  if (asked.at) return nearest_node(*asked.at, what, built);
  if (const int node = built.model.find_node(asked.node->name); node >= 0) return node;
  Names nodes("node");  // which say what is near
  for (const Node& node : built.model.nodes) nodes.add(node.name, {}, {});
  return nodes.find(*asked.node);
}

void check_columns(const std::vector<NameUsed>& names, const std::vector<Request>& requests) {
  Names columns("column of the output");
  for (const Request& request : requests) columns.add(request.name, {}, {});
  for (const NameUsed& name : names) columns.find(name);
}

void add_requests(const Case& read, const CaseNames& names, BuiltCase& built) {
  const CaseOutput& output = read.input->output;
  std::vector<Request>& requests = built.plan.requests;
  const Model& model = built.model;
  if (output.automatic) {
    const bool plane = model.space.dimension == 2;
    std::vector<std::string_view> top{"ux", "vx", "uy"}, base{"ux", "uy", "rz", "vy", "vrz"}, base_too{"rz", "vy", "vrz"};
    if (!plane)
      top = {"ux", "uy", "uz", "vx", "vy"}, base = {"ux", "uy", "uz", "rx", "ry", "rz", "vz"}, base_too = {"rx", "ry", "rz", "vz"};
    if (!built.top_arm.isZero(0) && built.top != built.base)  // which turns about the node
      for (int k = model.space.dimension; k < model.space.unknowns(); ++k) top.push_back(to_string(model.space.dof(k)));
    if (built.top >= 0) add_node(model, built.top, top, requests);
    if (built.base >= 0) add_node(model, built.base, built.base != built.top ? base : base_too, requests);
    // the drift of the top needs the tilt of the base, which nodes of solids do not have
    const bool nodes_turn_not = built.top >= 0 && built.base >= 0 && !moves(model, built.base_turn());
    for (std::size_t k = 0; k < model.interfaces.size(); ++k)
      for (const InterfaceQuantity& quantity : quantities_of(model.interfaces[k], *built.behaviours[k])) {
        if (is_shear(quantity.kind) && !bears_shear(model.interfaces[k])) continue;
        if (quantity.in_pose != nullptr && !(nodes_turn_not && k == 0 && quantity.kind != Column::settlement)) continue;
        requests.push_back(make(quantity.kind, fmt::format("{}.{}", model.interfaces[k].name, quantity.word), quantity.unit));
        requests.back().interface = static_cast<int>(k);
      }
  }
  Names interfaces("interface"), columns("column");
  for (const Interface& interface : model.interfaces) interfaces.add(interface.name, {}, {});
  for (const Request& request : requests) columns.add(request.name, {}, {});
  for (const CaseHistory& history : output.histories) {
    if (history.name) check_name(history.name->name, "the column", history.name->where(), history.name->path());
    Request request = asked_request(history, read, built, names, interfaces);
    if (!has_quantity(built, request)) continue;
    const bool there = std::any_of(requests.begin(), requests.end(), [&](const Request& other) { return other.name == request.name; });
    if (there && !history.name) continue;  // one of the automatic ones
    if (request.name == "time") fail(history, "name", "a name other than that of the first column", in_quotes(request.name));
    columns.add(request.name, history.where("name"), history.path("name"));
    requests.push_back(std::move(request));
  }
  add_envelopes(output, built);
  if (output.energies)
    for (const EnergyQuantity& each : energy_quantities())
      if (has_energy(built, each.kind)) requests.push_back(make(each.kind, fmt::format("energy.{}", each.word), "J"));
}

}  // namespace uplift
