#include "uplift/model/hinges.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "uplift/elements/solid.h"
#include "uplift/model/rigid_parts.h"

namespace uplift {

namespace {

/// Beams at nodes, and which of these are nodes of solids.
struct Joints {
  std::vector<std::vector<int>> beams;   // of each node: the other ends
  std::vector<std::vector<int>> solids;  // of each node with beams: the elements
  explicit Joints(const Model& model) : beams(model.nodes.size()), solids(model.nodes.size()) {
    for (const auto& element : model.elements) {
      const auto nodes = element->nodes();
      if (!element->has_axis()) continue;
      beams[nodes[0]].push_back(nodes[1]);
      beams[nodes[1]].push_back(nodes[0]);
    }
    for (int i = 0; i < static_cast<int>(model.elements.size()); ++i)
      if (model.elements[i]->continuum() != nullptr)
        for (const int node : model.elements[i]->nodes())
          if (!beams[node].empty()) solids[node].push_back(i);
  }
};

/// The next node along a beam from its end that is something else than an inner node of the beam.
int beyond(const Joints& joints, int end) {
  int last = end, node = joints.beams[end].front();
  while (joints.solids[node].empty() && joints.beams[node].size() == 2 && node != end) {
    const int next = joints.beams[node][0] == last ? joints.beams[node][1] : joints.beams[node][0];
    last = std::exchange(node, next);
  }
  return node;
}

/// Whether constraints touch all rotations of a node.
bool held(const Model& model, int node) {
  const Space space = model.space;
  for (int i = space.dimension; i < space.unknowns(); ++i)
    if (!Sparse::InnerIterator(model.assembly.constraints, space.unknowns() * node + i)) return false;
  return true;
}

}  // namespace

std::vector<int> hinges(const Model& model) {
  if (std::ranges::none_of(model.elements, [](const auto& element) { return element->has_axis(); })) return {};
  const Joints joints(model);
  std::vector<int> found;
  for (int node = 0; node < static_cast<int>(joints.beams.size()); ++node) {
    const std::vector<int>& here = joints.solids[node];
    if (joints.beams[node].size() != 1 || here.empty() || held(model, node)) continue;
    const std::vector<int>& there = joints.solids[beyond(joints, node)];
    if (std::ranges::find_first_of(here, there) == here.end()) found.push_back(node);
  }
  return found;
}

namespace {

/// Beams along edges of solids and beams outside, from one of their nodes on.
class EmbeddedBeams {
 public:
  explicit EmbeddedBeams(const Model& model) : model_(model), joints_(model) {}

  std::optional<EmbeddedFoot> foot(int node) const {
    if (joints_.beams[node].size() != 2 || joints_.solids[node].empty() || held(model_, node)) return std::nullopt;
    int in = joints_.beams[node][0], out = joints_.beams[node][1];
    if (!along_solid(node, in)) std::swap(in, out);
    if (!along_solid(node, in) || along_solid(node, out)) return std::nullopt;
    EmbeddedFoot foot;
    foot.node = node;
    const Stretch inside = stretch(node, in, true), outside = stretch(node, out, false);
    foot.cells = static_cast<int>(inside.lengths.size());
    foot.cell = inside.lengths.front();
    foot.free_length = std::accumulate(outside.lengths.begin(), outside.lengths.end(), 0.0);
    foot.flexibility = flexibility(inside.lengths, held(model_, inside.end));
    return foot;
  }

  /// Whether the solids at the node are stiffer than the first stretch of the beam in them.
  bool held_by_solids(const EmbeddedFoot& foot) const {
    double bending = 0;  // the largest rotational stiffness of the beams there is 4 E I/l
    for (const auto& element : model_.elements) {
      if (!element->has_axis() || std::ranges::find(element->nodes(), foot.node) == element->nodes().end()) continue;
      Matrix stiffness;
      element->form({.stiffness = &stiffness});
      const auto nodes = element->nodes();
      const double length = (model_.nodes[nodes[1]].position - model_.nodes[nodes[0]].position).norm();
      for (int i = model_.space.dimension; i < model_.space.unknowns(); ++i) bending = std::max(bending, stiffness(i, i) * length / 4);
    }
    double solid = 0;
    for (const int element : joints_.solids[foot.node]) {
      const SolidSection& section = *model_.elements[element]->continuum();
      const double depth = model_.space.dimension == 2 ? section.thickness : foot.cell;
      solid = std::max(solid, section.material.young * foot.cell * foot.cell * depth);
    }
    return solid > bending / foot.flexibility;
  }

 private:
  struct Stretch {
    std::vector<double> lengths;  // m, of the beams one after another
    int end = 0;                  // its last node
  };

  bool along_solid(int a, int b) const {
    return std::ranges::find_first_of(joints_.solids[a], joints_.solids[b]) != joints_.solids[a].end();
  }
  double length(int a, int b) const { return (model_.nodes[b].position - model_.nodes[a].position).norm(); }

  /// Lengths of the beams from a node on, as long as they stay in (out of) solids and nothing branches off or holds the rotation.
  Stretch stretch(int from, int to, bool inside) const {
    Stretch found{{length(from, to)}, to};
    const int first = from;
    while (to != first && joints_.beams[to].size() == 2 && !held(model_, to)) {
      const int next = joints_.beams[to][0] == from ? joints_.beams[to][1] : joints_.beams[to][0];
      if (along_solid(to, next) != inside) break;
      from = std::exchange(to, next);
      found.lengths.push_back(length(from, to));
      found.end = to;
    }
    return found;
  }

  /// Three-moment equation, from the far end on: clamped there, or hinged.
  static double flexibility(const std::vector<double>& cells, bool clamped) {
    double f = cells.back() / (clamped ? 4 : 3);
    for (std::size_t i = cells.size() - 1; i-- > 0;) f = cells[i] / 3 - cells[i] * cells[i] / (36 * (cells[i] / 3 + f));
    return f;
  }

  const Model& model_;
  Joints joints_;
};

}  // namespace

std::vector<EmbeddedFoot> embedded_feet(const Model& model) {
  std::vector<EmbeddedFoot> feet;
  if (std::ranges::none_of(model.elements, [](const auto& element) { return element->has_axis(); })) return feet;
  const EmbeddedBeams beams(model);
  for (int node = 0; node < static_cast<int>(model.nodes.size()); ++node)
    if (const auto foot = beams.foot(node); foot && beams.held_by_solids(*foot)) feet.push_back(*foot);
  return feet;
}

std::string named_places(const Model& model, const std::vector<int>& nodes) {
  constexpr std::size_t most = 4;
  std::vector<std::string> said;
  for (std::size_t i = 0; i < std::min(most, nodes.size()); ++i) {
    const Node& node = model.nodes[nodes[i]];
    said.push_back(fmt::format("\"{}\" at {} m", node.name, to_string(node.position, model.space, 4)));
  }
  if (nodes.size() > most) said.push_back(fmt::format("{} more", nodes.size() - most));
  return fmt::format("{}", fmt::join(said, ", "));
}

}  // namespace uplift
