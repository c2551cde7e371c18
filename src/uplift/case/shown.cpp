#include "uplift/case/shown.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "uplift/case/schema/case_input.h"

namespace uplift {
namespace {

constexpr double equal = 1e-9;  // m

/// A node of the mesh that is shown gets a name that can be remembered, and is still found by its number.
void rename_shown(int node, const std::string& name, Model& model) {
  Node& shown = model.nodes[static_cast<std::size_t>(node)];
  if (shown.name.starts_with("mesh.") && model.find_node(name) < 0) model.second_names.emplace(std::exchange(shown.name, name), node);
}

/// Springs and dashpots between two nodes.
bool is_connector(const Element& element) {
  return element.nodes().size() == 2 && !element.has_axis() && element.continuum() == nullptr;
}

/// Of its translation.
double mass_of(const Element& element) {
  Matrix mass;
  element.form({.mass = &mass});
  double sum = 0;
  for (Index i = 0; i < mass.rows(); i += element.unknowns_per_node())
    for (Index j = 0; j < mass.cols(); j += element.unknowns_per_node()) sum += mass(i, j);
  return sum;
}

/// What stands on the first base, and on other bases there; without an interface everything. Of the nodes.
std::vector<char> structure_of(const BuiltCase& built) {
  if (built.facts.empty()) return std::vector<char>(built.model.nodes.size(), 1);
  std::vector<int> from = built.facts.front().upper;
  std::vector<char> part = part_of(built.model, from);
  const auto is_in = [&](int node) { return part[static_cast<std::size_t>(node)] != 0; };
  for (bool more = true; more;) {
    more = false;
    for (const InterfaceFacts& facts : built.facts)
      if (facts.role == Role::base && std::ranges::any_of(facts.lower, is_in) && !std::ranges::all_of(facts.upper, is_in))
        from.insert(from.end(), facts.upper.begin(), facts.upper.end()), more = true;
    if (more) part = part_of(built.model, from);
  }
  return part;
}

/// Takes out of a structure what hangs on it by springs alone: a piece beside one other that has a height of its own, lighter than a tenth
/// of the structure. A storey on springs stands on one without a height, or is no lighter.
void take_out_equipment(const BuiltCase& built, std::vector<char>& structure) {
  constexpr double light = 0.1;
  const Model& model = built.model;
  const std::vector<int> pieces = pieces_of(model, [](const Element& element) { return !is_connector(element); });
  const auto piece = [&](int node) { return pieces[static_cast<std::size_t>(node)]; };
  std::map<int, std::set<int>> beside;
  for (const auto& element : model.elements)
    if (const auto nodes = element->nodes(); is_connector(*element) && piece(nodes[0]) != piece(nodes[1]))
      beside[piece(nodes[0])].insert(piece(nodes[1])), beside[piece(nodes[1])].insert(piece(nodes[0]));
  if (!built.facts.empty())
    for (const int node : built.facts.front().upper) beside.erase(piece(node));
  if (beside.empty()) return;
  double whole = 0;
  std::map<int, double> masses;
  for (const auto& element : model.elements)
    if (const int node = element->nodes()[0]; structure[static_cast<std::size_t>(node)]) {
      const double mass = mass_of(*element);
      whole += mass;
      masses[piece(node)] += mass;
    }
  std::map<int, std::pair<double, double>> heights;
  for (int node = 0; node < static_cast<int>(pieces.size()); ++node) {
    const double height = model.nodes[static_cast<std::size_t>(node)].position.dot(model.up());
    const auto [found, first] = heights.try_emplace(piece(node), height, height);
    if (!first) found->second = {std::min(found->second.first, height), std::max(found->second.second, height)};
  }
  std::set<int> hung;
  for (const auto& [each, others] : beside)
    if (const auto& [least, most] = heights[*others.begin()]; others.size() == 1 && most - least > equal && masses[each] < light * whole)
      hung.insert(each);
  for (std::size_t node = 0; node < structure.size(); ++node)
    if (hung.contains(pieces[node])) structure[node] = 0;
}

/// Where a node that is no ground stands, or the centre of mass of a rigid body.
struct Candidate {
  int node = -1;
  Vec3 arm = Vec3::Zero();
};

std::vector<Candidate> candidates(const CaseInput& input, const CaseNames& names, const BuiltCase& built) {
  const Model& model = built.model;
  std::vector<char> structure = structure_of(built);
  take_out_equipment(built, structure);
  const auto moves_freely = [&](int node) {
    for (int k = 0; k < model.space.dimension; ++k)
      if (Sparse::InnerIterator(model.expansion, model.at(node, model.space.dof(k)))) return true;
    return false;
  };
  std::vector<Candidate> found;
  for (int node = 0; node < static_cast<int>(structure.size()); ++node)
    if (structure[static_cast<std::size_t>(node)] && !built.bare.contains(node) && moves_freely(node)) found.push_back({node});
  for (const CaseBody& body : input.bodies)
    if (const int node = master_of(body, names); body.centre && body.mass > 0 && structure[static_cast<std::size_t>(node)])
      found.push_back({node, *body.centre - names.positions[static_cast<std::size_t>(node)]});
  return found;
}

/// The highest one, of equally high ones that nearest to a place, of equally near ones the first: nodes before centres of mass.
Candidate highest(const std::vector<Candidate>& among, const Vec3& near, const Model& model) {
  const Vec3 up = model.up();
  const auto place = [&](const Candidate& each) { return Vec3(model.nodes[static_cast<std::size_t>(each.node)].position + each.arm); };
  Candidate best;
  for (const Candidate& each : among) {
    const double higher = best.node < 0 ? 1 : (place(each) - place(best)).dot(up);
    const bool nearer = best.node >= 0 && (place(each) - near).norm() < (place(best) - near).norm() - equal;
    if (higher > equal || (higher > -equal && nearer)) best = each;
  }
  return best;
}

void find_top(const Case& read, const CaseNames& names, BuiltCase& built) {
  if (const std::optional<NameUsed>& named = read.input->verdict.top) {
    built.top = names.node(*named);
    return;
  }
  const Model& model = built.model;
  Vec3 middle = Vec3::Zero();
  if (!built.facts.empty()) middle = model.interfaces.front().reference;
  if (built.facts.empty())
    for (const Node& node : model.nodes) middle += node.position / static_cast<double>(model.nodes.size());
  const Candidate found = highest(candidates(*read.input, names, built), middle, model);
  built.top = found.node;
  built.top_arm = found.arm;
}

/// The body of the first interface; on a mesh without one the upper node in the middle of the interface.
void find_base(const Case& read, BuiltCase& built) {
  if (built.facts.empty()) return;
  const InterfaceFacts& first = built.facts.front();
  if (!first.body.empty()) built.base = built.model.find_node(first.body);
  if (!read.mesh || built.base >= 0 || first.upper.empty()) return;
  const Vec3 middle = built.model.interfaces.front().reference;
  const auto distance = [&](int node) { return (built.model.nodes[static_cast<std::size_t>(node)].position - middle).norm(); };
  built.base = *std::ranges::min_element(first.upper, {}, distance);
}

/// See BuiltCase::sway.
Dof sway_of(const Model& model) {
  if (model.space.dimension == 2) return ux;
  Vec3 size = Vec3::Zero();
  for (const TimeLoad& time_load : model.time_loads)
    if (!time_load.dead)
      for (Index i = 0; i < time_load.shape.size(); ++i) {
        const int unknown = model.kept[static_cast<std::size_t>(i)];
        if (!model.space.is_rotation(unknown)) size[model.space.index_of(unknown)] += std::abs(time_load.shape[i]);
      }
  return size.y() > (1 + 1e-9) * size.x() ? uy : ux;  // of equal ones the first, whatever the order of the sums
}

}  // namespace

void find_shown(const Case& read, const CaseNames& names, BuiltCase& built) {
  built.bare = names.bare;
  find_base(read, built);
  find_top(read, names, built);
  if (built.top >= 0) rename_shown(built.top, "top", built.model);
  if (built.base >= 0) rename_shown(built.base, "base", built.model);
  built.sway = sway_of(built.model);
  for (std::size_t k = 0; k < built.facts.size(); ++k)
    built.constant_loads.push_back(constant_loads(built.model, built.model.interfaces[k], built.facts[k]));
}

std::string BuiltCase::name_of_top() const {
  if (top < 0) return "";
  const std::string& name = model.nodes[static_cast<std::size_t>(top)].name;
  return top_arm.isZero(0) ? "node " + name : "the centre of mass of " + name;
}

Request::Kind BuiltCase::base_moment() const {
  if (model.space.dimension == 2) return Request::Kind::moment;
  return sway == ux ? Request::Kind::moment_2 : Request::Kind::moment_1;
}

Request::Kind BuiltCase::base_rotation() const {
  if (model.space.dimension == 2) return Request::Kind::rotation;
  return sway == ux ? Request::Kind::rotation_2 : Request::Kind::rotation_1;
}

Request::Kind BuiltCase::base_tilt() const {
  return model.space.dimension == 3 && sway == ux ? Request::Kind::tilt_2 : Request::Kind::tilt_1;
}

}  // namespace uplift
