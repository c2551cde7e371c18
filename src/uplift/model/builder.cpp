#include "uplift/model/builder.h"

#include <fmt/format.h>

#include <cassert>
#include <numbers>

namespace uplift {

BulkDamping rayleigh(double frequency_1, double ratio_1, double frequency_2, double ratio_2) {
  assert(frequency_1 > 0 && frequency_2 > 0 && frequency_1 != frequency_2);
  const double w1 = 2 * std::numbers::pi * frequency_1, w2 = 2 * std::numbers::pi * frequency_2;
  BulkDamping damping;
  damping.beta = 2 * (ratio_2 * w2 - ratio_1 * w1) / (w2 * w2 - w1 * w1);
  damping.alpha = 2 * ratio_1 * w1 - damping.beta * w1 * w1;
  return damping;
}

int ModelBuilder::add_node(std::string name, Place position, Where where, std::string alias) {
  if (!node_names_.insert(name).second)
    throw InputError(std::move(where), "nodes." + name, "a name that no other node has", fmt::format("\"{}\" twice", name));
  if (!alias.empty()) second_names_.emplace(std::move(alias), static_cast<int>(nodes_.size()));
  nodes_.push_back({std::move(name), position});
  return static_cast<int>(nodes_.size()) - 1;
}

void ModelBuilder::add_element(std::unique_ptr<const Element> element, Where) {
  for ([[maybe_unused]] const int node : element->nodes()) assert(node >= 0 && node < static_cast<int>(nodes_.size()));
  elements_.push_back(std::move(element));
}

void ModelBuilder::reserve(std::size_t nodes, std::size_t elements) {
  nodes_.reserve(nodes_.size() + nodes);
  node_names_.reserve(node_names_.size() + nodes);
  elements_.reserve(elements_.size() + elements);
}

void ModelBuilder::fix(int node, Dof dof, Where where, bool repeats) {
  supports_.push_back({node, dof, -1, std::move(where), repeats});
}

void ModelBuilder::prescribe(int node, Dof dof, std::shared_ptr<const TimeFunction> motion, std::string name, Where where) {
  supports_.push_back({node, dof, static_cast<int>(motions_.size()), std::move(where), false});
  motions_.push_back({std::move(name), std::move(motion)});
}

void ModelBuilder::prescribe(const std::vector<int>& nodes, Dof dof, std::shared_ptr<const TimeFunction> motion, std::string name,
                             const Where& where) {
  for (const int node : nodes) supports_.push_back({node, dof, static_cast<int>(motions_.size()), where, nodes.size() > 1});
  motions_.push_back({std::move(name), std::move(motion)});
}

void ModelBuilder::tie_equal(int a, int b, Dof dof, Where where) {
  assert(a != b);
  equals_.push_back({a, b, dof, std::move(where)});
}

void ModelBuilder::follow(int node, const std::vector<std::pair<int, double>>& of, const Where& where) {
  const int each = space_.unknowns();
  for (int k = 0; k < each; ++k) {
    std::vector<std::pair<int, double>> terms{{each * node + k, 1}};
    if (!space_.is_rotation(k))
      for (const auto& [other, weight] : of) terms.emplace_back(each * other + k, -weight);
    relate(std::move(terms), where);
  }
}

void ModelBuilder::relate(std::vector<std::pair<int, double>> terms, Where where) {
  relations_.push_back({std::move(terms), std::move(where)});
}

void ModelBuilder::tie_rigid(int master, int slave, Where where) {
  ties_.push_back({master, slave, std::move(where)});
}

void ModelBuilder::inextensible(int a, int b, Where where) {
  if (!((nodes_[b].position - nodes_[a].position).norm() > 0))
    throw InputError(std::move(where), "beam.nodes", "two nodes apart from each other",
                     fmt::format("\"{}\" and \"{}\" at the same place", nodes_[a].name, nodes_[b].name));
  links_.push_back({a, b, std::move(where)});
}

void ModelBuilder::add_interface(InterfaceSpec spec, Where where) {
  assert(spec.components - spec.rotations == 1 || spec.components - spec.rotations == space_.dimension);
  assert(!spec.law != !spec.cone);
  if (spec.points.empty()) throw InputError(std::move(where), "interface." + spec.name, "at least one point", "none");
  for (const JointPoint& point : spec.points)
    if (!(point.area > 0))
      throw InputError(std::move(where), "interface." + spec.name, "points with an area > 0 m2", fmt::format("{:g}", point.area));
  interfaces_.push_back(std::move(spec));
  interface_where_.push_back(std::move(where));
}

void ModelBuilder::add_load(std::string name, std::vector<std::pair<int, double>> pattern, std::shared_ptr<const TimeFunction> function,
                            bool dead, Where where) {
  loads_.push_back({std::move(name), std::move(pattern), std::move(function), dead, std::move(where)});
}

void ModelBuilder::add_feed(std::string name, std::vector<Triplet> pattern, int functions, std::shared_ptr<const TimeFunctions> values) {
  tables_.push_back({std::move(name), std::move(pattern), functions, std::move(values)});
}

void ModelBuilder::set_gravity(Place acceleration, Where) {
  gravity_ = acceleration;
}

void ModelBuilder::add_ground_acceleration(Place direction, std::shared_ptr<const TimeFunction> acceleration, std::string name, Where) {
  grounds_.push_back({std::move(name), direction, std::move(acceleration)});
}

void ModelBuilder::set_damping(BulkDamping damping) {
  damping_ = std::move(damping);
}

std::string ModelBuilder::name_of(int full_unknown) const {
  return fmt::format("{}.{}", nodes_[space_.node_of(full_unknown)].name, to_string(space_.dof(space_.index_of(full_unknown))));
}

}  // namespace uplift
