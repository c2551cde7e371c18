#include "uplift/case/advice/swaying_solids.h"

#include <algorithm>
#include <cmath>

#include "uplift/case/mesh/mesh.h"
#include "uplift/model/rigid_parts.h"

namespace uplift {
namespace {

double height_at(const Model& model, int node) {
  return model.nodes[static_cast<std::size_t>(node)].position.dot(model.up());
}

/// Lowest and highest place of the deformable solids among these nodes [m]; low > high: none.
std::pair<double, double> range_of_solids(const Model& model, const std::vector<char>& carried) {
  const std::vector<bool> tied = tied_nodes(model);
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const auto& element : model.elements) {
    const std::span<const int> nodes = element->nodes();
    if (element->continuum() == nullptr || !carried[static_cast<std::size_t>(nodes.front())]) continue;
    // the master of a rigid body may be one of them
    if (std::ranges::count_if(nodes, [&](int node) { return !tied[static_cast<std::size_t>(node)]; }) <= 1) continue;
    for (const int node : nodes) low = std::min(low, height_at(model, node)), high = std::max(high, height_at(model, node));
  }
  return {low, high};
}

}  // namespace

std::vector<WeightAtHeight> weights_at_heights(const Model& model, const std::vector<char>& chosen) {
  const Space space = model.space;
  const Vec3 up = model.up();
  std::vector<WeightAtHeight> found;
  for (std::size_t i = 0; i < model.time_loads.size(); ++i) {
    if (!model.time_loads[i].dead) continue;
    for (SparseVector::InnerIterator entry(model.assembly.loads[i]); entry; ++entry) {
      const int unknown = static_cast<int>(entry.index()), node = space.node_of(unknown), k = space.index_of(unknown);
      if (chosen[static_cast<std::size_t>(node)] && !space.is_rotation(k))
        found.push_back({-entry.value() * up.dot(space.axis(k)), height_at(model, node)});
    }
  }
  for (const auto& element : model.elements) {
    const int node = element->nodes().front();
    if (!chosen[static_cast<std::size_t>(node)] || element->first_moment().isZero(0)) continue;
    Matrix mass;
    element->form({.mass = &mass});
    const double weight = mass(0, 0) * model.assembly.gravity.norm(), height = height_at(model, node);
    found.push_back({-weight, height});
    found.push_back({weight, height + element->first_moment().dot(up) / mass(0, 0)});
  }
  return found;
}

double second_order_of_solids(const BuiltCase& built) {
  const Model& model = built.model;
  if (built.facts.empty() || built.facts.front().upper.empty()) return 0;
  const std::vector<int>&base = built.facts.front().upper, &ground = built.facts.front().lower;
  const std::vector<char> carried = part_of(model, base);
  // where a surface ends inside the soil, what it carries cannot be told from the soil
  if (std::ranges::any_of(ground, [&](int node) { return carried[static_cast<std::size_t>(node)] != 0; })) return 0;
  double foot = HUGE_VAL;
  for (const int node : base) foot = std::min(foot, height_at(model, node));
  const auto [lowest, high] = range_of_solids(model, carried);
  const double low = std::max(lowest, foot);
  if (!(high > low)) return 0;
  double all = 0, of_solids = 0;  // N m
  for (const auto& [weight, height] : weights_at_heights(model, carried)) {
    all += weight * std::max(0.0, height - foot);
    of_solids += weight * (std::clamp(height, low, high) - low);
  }
  return all > 0 ? std::max(0.0, of_solids / all) : 0;
}

}  // namespace uplift
