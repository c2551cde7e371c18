#pragma once
#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "uplift/mesh/mesh.h"

namespace uplift::support {

/// The same mesh with its nodes in arbitrary order.
inline Mesh shuffled(Mesh mesh, unsigned seed) {
  std::vector<int> number(mesh.nodes.size());
  std::iota(number.begin(), number.end(), 0);
  std::ranges::shuffle(number, std::mt19937(seed));
  const std::vector<Vec3> nodes = mesh.nodes;
  for (std::size_t node = 0; node < nodes.size(); ++node) mesh.nodes[static_cast<std::size_t>(number[node])] = nodes[node];
  const auto renumber = [&](std::vector<int>& list) {
    for (int& node : list) node = number[static_cast<std::size_t>(node)];
  };
  for (CellBlock& block : mesh.blocks) renumber(block.nodes);
  for (auto& [name, group] : mesh.groups) renumber(group.nodes), std::ranges::sort(group.nodes);
  return mesh;
}

}  // namespace uplift::support
