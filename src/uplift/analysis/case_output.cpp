#include "uplift/analysis/case_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "uplift/analysis/case_model.h"

namespace uplift {
namespace {

using Column = Request::Kind;

struct NodeQuantity {
  std::string_view word;
  Column kind;
  int dof;
  std::string_view unit;
};
constexpr std::array<NodeQuantity, 9> node_quantities{{{"ux", Column::displacement, ux, "m"},
                                                       {"uy", Column::displacement, uy, "m"},
                                                       {"rz", Column::displacement, rz, "rad"},
                                                       {"vx", Column::velocity, ux, "m/s"},
                                                       {"vy", Column::velocity, uy, "m/s"},
                                                       {"vrz", Column::velocity, rz, "rad/s"},
                                                       {"ax", Column::acceleration, ux, "m/s2"},
                                                       {"ay", Column::acceleration, uy, "m/s2"},
                                                       {"arz", Column::acceleration, rz, "rad/s2"}}};

struct Quantity {
  std::string_view word;
  Column kind;
  std::string_view unit;
};
constexpr std::array<Quantity, 7> interface_quantities{{{"axial", Column::axial, "N"},
                                                        {"shear", Column::shear, "N"},
                                                        {"moment", Column::moment, "N m"},
                                                        {"rotation", Column::rotation, "rad"},
                                                        {"uplifted_ratio", Column::uplifted_ratio, "1"},
                                                        {"max_opening", Column::max_opening, "m"},
                                                        {"max_pressure", Column::max_pressure, "Pa"}}};
constexpr std::array<Quantity, 8> energy_quantities{{{"kinetic", Column::kinetic, "J"},
                                                     {"strain", Column::strain, "J"},
                                                     {"stored", Column::stored, "J"},
                                                     {"interface_dissipated", Column::interface_dissipated, "J"},
                                                     {"damping", Column::damping, "J"},
                                                     {"impact", Column::impact, "J"},
                                                     {"external", Column::external, "J"},
                                                     {"residual", Column::residual, "J"}}};

struct PointQuantity {
  std::string_view word;
  Column kind;
  bool normal;
  std::string_view unit;
};
constexpr std::array<PointQuantity, 6> point_quantities{{{"opening", Column::opening, true, "m"},
                                                         {"slip", Column::opening, false, "m"},
                                                         {"traction", Column::traction, true, "Pa"},
                                                         {"shear_traction", Column::traction, false, "Pa"},
                                                         {"mean_traction", Column::mean_traction, true, "Pa"},
                                                         {"mean_shear_traction", Column::mean_traction, false, "Pa"}}};

/// The entry with this word; InputError with the list and the nearest word when there is none.
template <class Table>
const auto& find_quantity(const Table& table, const Values& history, const char* of) {
  const std::string& word = history.text("quantity");
  std::vector<std::string> words;
  for (const auto& entry : table) {
    if (entry.word == word) return entry;
    words.emplace_back(entry.word);
  }
  throw InputError(history.where("quantity"), history.path("quantity"), fmt::format("a quantity of {}: {}", of, fmt::join(words, ", ")),
                   "\"" + word + "\"", nearest_name(word, words));
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
  request.unknown = 3 * node + quantity.dof;
  return request;
}

void add_node(const Model& model, int node, std::vector<std::string_view> words, std::vector<Request>& requests) {
  for (const NodeQuantity& quantity : node_quantities)
    if (std::find(words.begin(), words.end(), quantity.word) != words.end() && moves(model, 3 * node + quantity.dof))
      requests.push_back(node_request(model, node, quantity));
}

Request point_request(const Values& history, const Model& model, int interface, std::string name) {
  const Interface& joint = model.interfaces[interface];
  const int point = history.integer("point");
  if (point > joint.batch.points)
    throw InputError(history.where("point"), history.path("point"),
                     fmt::format("a point of \"{}\", from 1 to {}", joint.name, joint.batch.points), fmt::format("{}", point));
  const PointQuantity& quantity = find_quantity(point_quantities, history, "an interface point");
  if (!quantity.normal && joint.batch.components == 1)
    throw InputError(history.where("quantity"), history.path("quantity"),
                     fmt::format("a normal quantity: \"{}\" has no tangential part", joint.name), "\"" + history.text("quantity") + "\"");
  if (name.empty()) name = fmt::format("{}.{}.{}", joint.name, point, quantity.word);
  Request request = make(quantity.kind, std::move(name), quantity.unit);
  request.interface = interface;
  request.point = point - 1;
  request.component = quantity.normal ? joint.batch.components - 1 : 0;
  return request;
}

/// The node nearest to a place; of nodes at the same place (the sides of an interface) the first, that of the lower side.
int nearest_node(const Values& history, Built& built) {
  const Vec2 place = vec2(history.numbers("at"));
  int nearest = 0;
  const auto distance = [&](int node) { return (built.model.nodes[static_cast<std::size_t>(node)].position - place).norm(); };
  for (int node = 1; node < static_cast<int>(built.model.nodes.size()); ++node)
    if (distance(node) < distance(nearest) - 1e-9) nearest = node;
  const Node& found = built.model.nodes[static_cast<std::size_t>(nearest)];
  built.notes.push_back(fmt::format("{} at ({:g}, {:g}) m: node {} at ({:g}, {:g}) m, {:.3g} m away", history.text("quantity"), place.x(),
                                    place.y(), found.name, found.position.x() + 0.0, found.position.y() + 0.0, distance(nearest)));
  return nearest;
}

Request asked_request(const Values& history, Built& built, const Names& nodes, const Names& interfaces) {
  const std::string name = history.has("name") ? history.text("name") : "";
  const int given = history.has("node") + history.has("at") + history.has("interface");
  if (given != 1)
    throw InputError(history.where(), history.path(), "exactly one of node, at and interface",
                     given == 0 ? "none" : fmt::format("{}", given));
  if (!history.has("interface")) {
    const int node = history.has("node") ? nodes.find(history, "node") : nearest_node(history, built);
    return node_request(built.model, node, find_quantity(node_quantities, history, "a node"), name);
  }
  const int interface = interfaces.find(history, "interface");
  if (history.has("point")) return point_request(history, built.model, interface, name);
  const Quantity& quantity = find_quantity(interface_quantities, history, "an interface");
  Request request =
      make(quantity.kind, name.empty() ? fmt::format("{}.{}", built.model.interfaces[interface].name, quantity.word) : name, quantity.unit);
  request.interface = interface;
  return request;
}

}  // namespace

bool moves(const Model& model, int full_unknown) {
  if (Sparse::InnerIterator(model.expansion, full_unknown)) return true;
  return std::any_of(model.motions.begin(), model.motions.end(),
                     [&](const PrescribedMotion& motion) { return motion.shape[full_unknown] != 0; });
}

void check_columns(const Values& table, std::string_view key, const std::vector<Request>& requests) {
  Names columns("column of the output");
  for (const Request& request : requests) columns.add(request.name, {}, {});
  for (const std::string& name : table.texts(key)) columns.find(name, table.where(key), table.path(key));
}

void add_requests(const Case& read, Built& built) {
  const Values& output = read.values.table("output");
  std::vector<Request>& requests = built.plan.requests;
  const Model& model = built.model;
  if (output.flag("automatic")) {
    if (built.top >= 0) add_node(model, built.top, {"ux", "vx", "uy"}, requests);
    if (built.base >= 0 && built.base != built.top) add_node(model, built.base, {"ux", "uy", "rz", "vy", "vrz"}, requests);
    if (built.base >= 0 && built.base == built.top) add_node(model, built.base, {"rz", "vy", "vrz"}, requests);
    for (std::size_t k = 0; k < model.interfaces.size(); ++k)
      for (const Quantity& quantity : interface_quantities) {
        if (quantity.kind == Column::shear && model.interfaces[k].batch.components == 1) continue;
        requests.push_back(make(quantity.kind, fmt::format("{}.{}", model.interfaces[k].name, quantity.word), quantity.unit));
        requests.back().interface = static_cast<int>(k);
      }
  }
  Names nodes("node"), interfaces("interface"), columns("column");
  for (const Node& node : model.nodes) nodes.add(node.name, {}, {});
  for (const Interface& interface : model.interfaces) interfaces.add(interface.name, {}, {});
  for (const Request& request : requests) columns.add(request.name, {}, {});
  for (const Values& history : output.tables("history")) {
    Request request = asked_request(history, built, nodes, interfaces);
    const bool there = std::any_of(requests.begin(), requests.end(), [&](const Request& other) { return other.name == request.name; });
    if (there && !history.has("name")) continue;  // one of the automatic ones
    columns.add(request.name, history.where(), history.path());
    requests.push_back(std::move(request));
  }
  if (output.flag("energies"))
    for (const Quantity& quantity : energy_quantities)
      requests.push_back(make(quantity.kind, fmt::format("energy.{}", quantity.word), quantity.unit));
}

}  // namespace uplift
