#include "uplift/model/rigid_pieces.h"

#include <algorithm>
#include <numeric>

#include "uplift/elements/solid.h"

namespace uplift {

namespace {

constexpr int few = 30;  // nodes that move freely: pieces with fewer are taken as they are

const Solid* solid_of(const Element& element) {
  return dynamic_cast<const Solid*>(&element);
}

}  // namespace

bool is_solid(const Element& element) {
  return solid_of(element) != nullptr;
}

std::vector<int> kept_translations(const Model& model) {
  std::vector<int> kept(model.nodes.size(), 0);
  for (const int unknown : model.kept)
    if (!model.space.is_rotation(unknown)) ++kept[model.space.node_of(unknown)];
  return kept;
}

std::vector<int> solid_pieces(const Model& model) {
  std::vector<int> parent(model.nodes.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int node) {
    while (parent[node] != node) node = parent[node] = parent[parent[node]];
    return node;
  };
  for (const auto& element : model.elements)
    if (is_solid(*element))
      for (const int node : element->nodes()) parent[root(node)] = root(element->nodes()[0]);
  std::vector<int> size(model.nodes.size(), 0), number(model.nodes.size(), -1), piece(model.nodes.size(), -1);
  const int nodes = static_cast<int>(parent.size());
  const std::vector<int> kept = kept_translations(model);
  for (int node = 0; node < nodes; ++node)
    if (kept[node] == model.space.dimension) ++size[root(node)];
  int next = 0;
  for (int node = 0; node < nodes; ++node) {
    const int top = root(node);
    if (size[top] < few) continue;
    if (number[top] < 0) number[top] = next++;
    piece[node] = number[top];
  }
  return piece;
}

Sparse rigid_motions(const Model& model, const std::vector<int>& pieces) {
  const Space space = model.space;
  const int each = space.unknowns(), count = pieces.empty() ? 0 : *std::ranges::max_element(pieces) + 1;
  std::vector<Vec3> middle(count, Vec3::Zero());
  std::vector<double> nodes(count, 0);
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (pieces[i] >= 0) middle[pieces[i]] += model.nodes[i].position, ++nodes[pieces[i]];
  std::vector<Triplet> entries;
  std::vector<int> column(each * count, -1);  // of each motion of each piece, once it moves something
  int columns = 0;
  for (int i = 0; i < model.free(); ++i) {
    const int unknown = model.kept[i], node = space.node_of(unknown), index = space.index_of(unknown), piece = pieces[node];
    if (piece < 0 || space.is_rotation(unknown)) {
      entries.emplace_back(i, columns++, 1.0);
      continue;
    }
    const Vec3 r = model.nodes[node].position - middle[piece] / nodes[piece];
    for (int j = 0; j < each; ++j) {
      const double moved = space.motion(j, r).dot(space.axis(index));
      if (moved == 0) continue;
      int& at = column[each * piece + j];
      if (at < 0) at = columns++;
      entries.emplace_back(i, at, moved);
    }
  }
  Sparse motions(model.free(), columns);
  motions.setFromTriplets(entries.begin(), entries.end());
  return motions;
}

std::vector<char> moved_by_solid_mass(const Model& model) {
  std::vector<char> massive(model.nodes.size(), 0);
  for (const auto& element : model.elements)
    if (const Solid* solid = solid_of(*element);
        solid && solid->section().mass != SolidSection::Mass::none && solid->section().material.density > 0)
      for (const int node : element->nodes()) massive[node] = 1;
  std::vector<char> moved(model.free(), 0);
  for (int i = 0; i < model.free(); ++i) moved[i] = massive[model.space.node_of(model.kept[i])] && !model.space.is_rotation(model.kept[i]);
  return moved;
}

}  // namespace uplift
