#include <algorithm>
#include <numeric>

#include "uplift/mesh/cut_filling.h"
#include "uplift/mesh/index.h"

namespace uplift {
void compact(CutWork& work, std::vector<std::vector<CutFace>>& faces, std::vector<std::vector<FreeFace>>& free) {
  Mesh& mesh = work.mesh;
  std::vector<std::vector<int>> index;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    CellBlock& block = mesh.blocks[b];
    CellBlock kept{block.cell, {}};
    std::vector<int>& of_block = index.emplace_back(at(block.count()), -1);
    if (std::ranges::find(work.removed[b], true) == work.removed[b].end()) {
      std::iota(of_block.begin(), of_block.end(), 0);
      continue;
    }
    for (int i = 0; i < block.count(); ++i) {
      if (work.removed[b][at(i)]) continue;
      of_block[at(i)] = kept.count();
      kept.nodes.insert(kept.nodes.end(), block[i].begin(), block[i].end());
      if (!block.file_number.empty()) kept.file_number.push_back(block.file_number[at(i)]);
    }
    block = std::move(kept);
  }
  const auto moved = [&](CellId id) { return CellId{id.block, index[at(id.block)][at(id.index)]}; };
  for (auto& [name, group] : mesh.groups) {
    std::erase_if(group.cells, [&](CellId id) { return moved(id).index < 0; });
    for (CellId& id : group.cells) id = moved(id);
  }
  mesh.parts.renumber(index);
  for (std::vector<CutFace>& of_plane : faces)
    for (CutFace& face : of_plane) face.lower = moved(face.lower), face.upper = moved(face.upper);
  for (std::vector<FreeFace>& of_plane : free) {
    for (FreeFace& face : of_plane) face.cell = moved(face.cell);
    std::erase_if(of_plane, [](const FreeFace& face) { return face.cell.index < 0; });  // a lower plane has removed it
  }

  std::vector<int> number(mesh.nodes.size(), -1);
  for (const CellBlock& block : mesh.blocks)
    for (const int node : block.nodes) number[at(node)] = 0;
  std::size_t kept = 0;
  mesh.places.clear();
  mesh.places.reserve(number.size());
  for (std::size_t node = 0; node < number.size(); ++node)
    if (number[node] == 0) {
      mesh.nodes[kept] = mesh.nodes[node];
      mesh.places.push_back(static_cast<int>(node));
      number[node] = static_cast<int>(kept++);
    }
  mesh.nodes.resize(kept);
  for (CellBlock& block : mesh.blocks)
    for (int& node : block.nodes) node = number[at(node)];
  for (auto& [name, group] : mesh.groups) {
    std::erase_if(group.nodes, [&](int node) { return number[at(node)] < 0; });
    for (int& node : group.nodes) node = number[at(node)];
    std::ranges::sort(group.nodes);
  }
  std::erase_if(mesh.groups, [&](const auto& group) {
    const bool empty = group.second.cells.empty() && group.second.nodes.empty();
    if (empty) mesh.emptied.push_back(group.first);
    return empty;
  });
}

}  // namespace uplift
