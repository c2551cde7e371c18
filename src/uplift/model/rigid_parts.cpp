#include "uplift/model/rigid_parts.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "uplift/elements/solid.h"

namespace uplift {

namespace {

bool has_mass(const SolidSection& solid) {
  return solid.mass != SolidSection::Mass::none && solid.material.density > 0;
}

/// Sets of elements that are merged step by step.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void merge(int a, int b) { parent_[root(a)] = root(b); }

 private:
  std::vector<int> parent_;
};

/// Solids with a common side are merged. A side is looked at with its lowest corner, all of whose solids are at hand: there is never a list
/// of all sides.
void merge_solids(const Model& model, Sets& sets) {
  std::vector<int> start(model.nodes.size() + 1, 0), around;  // solids around each node
  const auto each_corner = [&](const auto& take) {            // node, element
    for (int e = 0; e < static_cast<int>(model.elements.size()); ++e) {
      const Element& solid = *model.elements[e];
      if (solid.continuum() == nullptr) continue;
      for (const int node : solid.nodes().first(info(solid.cell()).corners)) take(node, e);
    }
  };
  each_corner([&](int node, int) { ++start[node + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  around.resize(start.back());
  std::vector<int> next(start.begin(), start.end() - 1);
  each_corner([&](int node, int element) { around[next[node]++] = element; });
  std::vector<std::pair<std::array<int, 4>, int>> sides;  // corners, ascending; element
  for (int node = 0; node < static_cast<int>(model.nodes.size()); ++node) {
    sides.clear();
    for (int i = start[node]; i < start[node + 1]; ++i) {
      const Element& solid = *model.elements[around[i]];
      const CellInfo& type = info(solid.cell());
      for (int s = 0; s < static_cast<int>(type.sides.size()); ++s) {
        const auto side = side_of(solid.cell(), s);
        std::array<int, 4> corners;
        corners.fill(std::numeric_limits<int>::max());
        for (int c = 0; c < info(type.sides[s]).corners; ++c) corners[c] = solid.nodes()[side[c]];
        std::ranges::sort(corners);
        if (corners[0] == node) sides.emplace_back(corners, around[i]);
      }
    }
    std::ranges::sort(sides);
    for (std::size_t i = 1; i < sides.size(); ++i)
      if (sides[i].first == sides[i - 1].first) sets.merge(sides[i].second, sides[i - 1].second);
  }
}

/// Beams with a common node are merged.
void merge_beams(const Model& model, Sets& sets) {
  std::vector<int> first(model.nodes.size(), -1);
  for (int e = 0; e < static_cast<int>(model.elements.size()); ++e) {
    if (!model.elements[e]->has_axis()) continue;
    for (const int node : model.elements[e]->nodes()) {
      if (first[node] < 0) first[node] = e;
      sets.merge(e, first[node]);
    }
  }
}

}  // namespace

std::vector<RigidPart> rigid_parts(const Model& model) {
  Sets sets(model.elements.size());
  merge_solids(model, sets);
  merge_beams(model, sets);
  std::vector<RigidPart> parts;
  std::map<int, std::size_t> number;
  std::vector<std::size_t> last(model.nodes.size());  // part that each node was put into last, from 1 on: few are put there twice
  for (int e = 0; e < static_cast<int>(model.elements.size()); ++e) {
    const Element& element = *model.elements[e];
    const SolidSection* solid = element.continuum();
    if (solid == nullptr && !element.has_axis()) continue;
    const auto [at, fresh] = number.try_emplace(sets.root(e), parts.size());
    if (fresh) parts.emplace_back();
    RigidPart& part = parts[at->second];
    for (const int node : element.nodes())
      if (std::exchange(last[node], at->second + 1) != at->second + 1) part.nodes.push_back(node);
    part.beams = solid == nullptr;
    part.massive = part.massive || (solid != nullptr && has_mass(*solid));
  }
  for (RigidPart& part : parts) {
    std::ranges::sort(part.nodes);
    part.nodes.erase(std::ranges::unique(part.nodes).begin(), part.nodes.end());
    for (const int node : part.nodes) part.middle += model.nodes[node].position / static_cast<double>(part.nodes.size());
  }
  return parts;
}

std::vector<bool> tied_nodes(const Model& model) {
  std::vector<bool> tied(model.nodes.size(), false);
  for (const Assembly::Tie& tie : model.assembly.ties) tied[tie.slave] = true;
  return tied;
}

bool is_one_body(const std::vector<int>& nodes, const std::vector<bool>& tied) {
  return nodes.size() == 1 || (!nodes.empty() && std::ranges::all_of(nodes, [&](int node) { return tied[node]; }));
}

std::vector<char> moved_by_solid_mass(const Model& model) {
  std::vector<char> massive(model.nodes.size(), 0);
  for (const auto& element : model.elements)
    if (const SolidSection* solid = element->continuum(); solid != nullptr && has_mass(*solid))
      for (const int node : element->nodes()) massive[node] = 1;
  std::vector<char> moved(model.free(), 0);
  for (int i = 0; i < model.free(); ++i) moved[i] = massive[model.space.node_of(model.kept[i])] && !model.space.is_rotation(model.kept[i]);
  return moved;
}

}  // namespace uplift
