#include "uplift/case/shown.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace uplift {
namespace {

/// A node of the mesh that is shown gets a name that can be remembered, and is still found by its number.
void rename_shown(int node, const std::string& name, Model& model) {
  Node& shown = model.nodes[static_cast<std::size_t>(node)];
  if (shown.name.starts_with("mesh.") && model.find_node(name) < 0) model.second_names.emplace(std::exchange(shown.name, name), node);
}

/// The highest node, of equally high ones that nearest to a place; `among` leaves nodes out where it is 0, empty: none. `highest`: a node
/// to begin with, -1: none.
int highest_node(const CaseNames& names, const std::set<int>& bare, const Vec3& near, const std::vector<char>& among, int highest = -1) {
  const int up = names.space.up();
  const auto position = [&](int node) -> const Place& { return names.positions[static_cast<std::size_t>(node)]; };
  for (int node = 0; node < static_cast<int>(names.positions.size()); ++node) {
    if (bare.contains(node) || (!among.empty() && !among[static_cast<std::size_t>(node)])) continue;
    const double higher = highest < 0 ? 1 : position(node)[up] - position(highest)[up];
    const bool nearer = highest >= 0 && (position(node) - near).norm() < (position(highest) - near).norm();
    if (higher > 1e-9 || (higher > -1e-9 && nearer)) highest = node;
  }
  return highest;
}

/// Without an interface: the highest node, nearest to the middle of all. Else the highest one that is connected to the upper side of
/// the first interface, nearest to the middle of that, and the upper node in its middle.
void find_shown_mesh_nodes(const CaseNames& names, BuiltCase& built) {
  if (built.facts.empty()) {
    Vec3 middle = Vec3::Zero();
    for (const Place& place : names.positions) middle += place / static_cast<double>(names.positions.size());
    built.top = highest_node(names, built.bare, middle, {}, built.top);
    return rename_shown(built.top, "top", built.model);
  }
  const std::vector<int>& upper = built.facts.front().upper;
  const Vec3 middle = built.model.interfaces.front().reference;
  const auto distance = [&](int node) { return (names.positions[static_cast<std::size_t>(node)] - middle).norm(); };
  if (built.base < 0) built.base = *std::ranges::min_element(upper, {}, distance);
  if (built.top < 0) built.top = highest_node(names, built.bare, middle, part_of(built.model, upper));
  rename_shown(built.top, "top", built.model);
  rename_shown(built.base, "base", built.model);
}

/// The node of the highest mass (the largest of equally high ones), and the body of the first interface. With a mesh, whose cells have
/// masses of their own, only point masses count.
void find_shown_nodes(const Case& read, const CaseNames& names, BuiltCase& built) {
  double height = -std::numeric_limits<double>::infinity(), largest = 0;
  const auto look = [&](int node, double mass) {
    const double y = names.positions[static_cast<std::size_t>(node)][names.space.up()];
    if (y > height || (y == height && mass > largest)) {
      height = y;
      largest = mass;
      built.top = node;
    }
  };
  for (const CaseMass& mass : read.input->masses) look(names.node(mass.node), mass.mass.value_or(0));
  for (const CaseBody& body : read.input->bodies)
    if (!read.mesh && body.mass > 0) look(master_of(body, names), body.mass);
  if (built.top < 0 && !read.mesh)
    for (const CaseNode& node : read.input->nodes) look(names.nodes.find(node.name, node.where(), node.path()), 0);
  if (!built.facts.empty() && !built.facts[0].body.empty()) built.base = built.model.find_node(built.facts[0].body);
  if (read.mesh) find_shown_mesh_nodes(names, built);
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
  return size.y() > size.x() ? uy : ux;
}

/// See BuiltCase::weight.
double weight_of(const BuiltCase& built) {
  const Model& model = built.model;
  if (model.interfaces.empty()) return 0;
  const Vec3 normal = mean_normal(model.interfaces.front());
  const std::vector<char> carried = part_of(model, built.facts.front().upper);
  double weight = 0;
  for (std::size_t i = 0; i < model.time_loads.size(); ++i) {
    if (!model.time_loads[i].dead) continue;
    for (int node = 0; node < static_cast<int>(carried.size()); ++node)
      if (carried[static_cast<std::size_t>(node)])
        for (int k = 0; k < model.space.dimension; ++k)
          weight -= model.assembly.loads[i].coeff(model.space.unknowns() * node + k) * normal[k];
  }
  return weight;
}

}  // namespace

void find_shown(const Case& read, const CaseNames& names, BuiltCase& built) {
  built.bare = names.bare;
  find_shown_nodes(read, names, built);
  built.sway = sway_of(built.model);
  built.weight = weight_of(built);
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
