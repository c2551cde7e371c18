#include "uplift/model/hinges.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "uplift/elements/beam.h"
#include "uplift/elements/space_beam.h"
#include "uplift/model/rigid_pieces.h"

namespace uplift {

namespace {

bool is_beam(const Element& element) {
  return dynamic_cast<const Beam*>(&element) || dynamic_cast<const SpaceBeam*>(&element);
}

/// Beams at nodes, and which of these are nodes of solids.
struct Joints {
  std::vector<std::vector<int>> beams;   // of each node: the other ends
  std::vector<std::vector<int>> solids;  // of each node with beams: the elements
  explicit Joints(const Model& model) : beams(model.nodes.size()), solids(model.nodes.size()) {
    for (const auto& element : model.elements) {
      const auto nodes = element->nodes();
      if (!is_beam(*element)) continue;
      beams[nodes[0]].push_back(nodes[1]);
      beams[nodes[1]].push_back(nodes[0]);
    }
    for (int i = 0; i < static_cast<int>(model.elements.size()); ++i)
      if (is_solid(*model.elements[i]))
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
  if (std::ranges::none_of(model.elements, [](const auto& element) { return is_beam(*element); })) return {};
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
