#include "uplift/mesh/sides.h"

#include <algorithm>
#include <cassert>

namespace uplift {
namespace {

struct Key {
  int lowest;
  std::array<int, 3> above;
  std::int64_t others;
};

Key key_of(std::span<const int> corners, std::span<const int> others) {
  assert(corners.size() >= 2 && corners.size() <= 4);
  std::array<int, 4> sorted{};
  for (std::size_t i = 0; i < corners.size(); ++i) {  // insertion: at most four
    std::size_t j = i;
    for (; j > 0 && sorted[j - 1] > corners[i]; --j) sorted[j] = sorted[j - 1];
    sorted[j] = corners[i];
  }
  for (std::size_t i = corners.size(); i < 4; ++i) sorted[i] = -1;
  Key key{sorted[0], {sorted[1], sorted[2], sorted[3]}, 0};
  for (const int node : others) key.others += node;
  return key;
}

}  // namespace

int NodeSets::in_chain(int lowest, const Set& set) const {
  int at = head_[static_cast<std::size_t>(lowest)];
  while (at >= 0) {
    const Set& other = sets_[static_cast<std::size_t>(at)];
    if (other.above == set.above && other.others == set.others) break;
    at = other.next;
  }
  return at;
}

int NodeSets::insert(std::span<const int> corners, std::span<const int> others) {
  const Key key = key_of(corners, others);
  int& head = head_[static_cast<std::size_t>(key.lowest)];
  const Set set{key.above, head, key.others};
  const int found = in_chain(key.lowest, set);
  if (found >= 0) return found;
  head = size();
  sets_.push_back(set);
  return head;
}

int NodeSets::find(std::span<const int> corners, std::span<const int> others) const {
  const Key key = key_of(corners, others);
  return in_chain(key.lowest, {key.above, -1, key.others});
}

Sides::Sides(const Mesh& mesh, std::vector<CellId> cells)
    : cells_(std::move(cells)), counts_(cells_.size()), twin_(cells_.size() * stride, -1), sets_(mesh.nodes.size()) {
  std::vector<bool> shared;
  std::array<int, 9> face{};
  for (std::size_t k = 0; k < cells_.size(); ++k) {
    const CellInfo& type = info(mesh.type(cells_[k]));
    assert(type.dimension == mesh.dimension);
    const auto nodes = mesh.cell(cells_[k]);
    counts_[k] = static_cast<unsigned char>(type.sides.size());
    const int* next = type.side_nodes.data();
    for (std::size_t s = 0; s < type.sides.size(); ++s) {
      const CellInfo& side = info(type.sides[s]);
      const auto n = static_cast<std::size_t>(side.nodes), corners = static_cast<std::size_t>(side.corners);
      for (std::size_t i = 0; i < n; ++i) face[i] = nodes[static_cast<std::size_t>(*next++)];
      const auto set =
          static_cast<std::size_t>(sets_.insert(std::span(face).first(corners), std::span(face).subspan(corners, n - corners)));
      const int number = static_cast<int>(k) * stride + static_cast<int>(s);
      if (set == first_.size()) {
        first_.push_back(number);
        shared.push_back(false);
      } else if (shared[set]) {
        if (crowded_ < 0) crowded_ = number;
      } else {
        shared[set] = true;
        twin_[static_cast<std::size_t>(number)] = first_[set];
        twin_[static_cast<std::size_t>(first_[set])] = number;
      }
    }
  }
}

int Sides::find(Cell face, std::span<const int> nodes) const {
  const auto corners = static_cast<std::size_t>(info(face).corners);
  const int set = sets_.find(nodes.first(corners), nodes.subspan(corners));
  return set < 0 ? -1 : first_[static_cast<std::size_t>(set)];
}

void Sides::nodes_of(const Mesh& mesh, int side, std::vector<int>& nodes) const {
  const CellId id = cells_[static_cast<std::size_t>(side / stride)];
  const auto cell = mesh.cell(id);
  nodes.clear();
  for (const int i : side_of(mesh.type(id), side % stride)) nodes.push_back(cell[static_cast<std::size_t>(i)]);
}

std::vector<CellId> full_cells(const Mesh& mesh) {
  std::vector<CellId> cells;
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b) {
    const CellBlock& block = mesh.blocks[static_cast<std::size_t>(b)];
    if (info(block.cell).dimension != mesh.dimension) continue;
    for (int i = 0; i < block.count(); ++i) cells.push_back({b, i});
  }
  return cells;
}

}  // namespace uplift
