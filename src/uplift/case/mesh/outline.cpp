#include "uplift/case/mesh/outline.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "uplift/mesh/index.h"

namespace uplift {
namespace {

using Edge = std::array<int, 2>;

/// Edges of a cell between its corners, the cell on their left; those of second degree in two halves.
std::vector<Edge> edges_of(const Mesh& mesh, CellId id) {
  const CellInfo& cell = info(mesh.type(id));
  const std::span<const int> nodes = mesh.cell(id);
  std::vector<Edge> edges;
  for (int side = 0; side < static_cast<int>(cell.sides.size()); ++side) {
    const std::span<const int> of_side = side_of(cell.cell, side);
    const int a = nodes[at(of_side[0])], b = nodes[at(of_side[1])];
    if (of_side.size() == 2) {
      edges.push_back({a, b});
    } else {
      const int middle = nodes[at(of_side[2])];
      edges.push_back({a, middle});
      edges.push_back({middle, b});
    }
  }
  return edges;
}

/// The edges that one cell of the group has alone, strung together: closed lines, first node = last node.
std::vector<std::vector<int>> boundary(const Mesh& mesh, const Group& group) {
  std::set<Edge> single;
  for (const CellId cell : group.cells)
    for (const Edge& edge : edges_of(mesh, cell))
      if (!single.erase({edge[1], edge[0]})) single.insert(edge);
  std::vector<std::vector<int>> lines;
  while (!single.empty()) {
    std::vector<int> line{(*single.begin())[0]};
    for (;;) {
      const auto next = single.lower_bound({line.back(), -1});
      if (next == single.end() || (*next)[0] != line.back()) break;
      line.push_back((*next)[1]);
      single.erase(next);
      if (line.back() == line.front()) break;
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

/// Cosine of one degree: where a line turns more, its node is a corner.
constexpr double straight = 0.99985;

bool corner(const Mesh& mesh, int before, int here, int after) {
  const Vec3 a = (mesh.nodes[at(here)] - mesh.nodes[at(before)]).normalized();
  const Vec3 b = (mesh.nodes[at(after)] - mesh.nodes[at(here)]).normalized();
  return a.dot(b) < straight;
}

void take_corners(const Mesh& mesh, const std::vector<int>& line, std::set<int>& taken) {
  const std::size_t n = line.size() - 1;  // the last is the first again
  taken.insert(line.front());
  for (std::size_t i = 0; i < n; ++i)
    if (corner(mesh, line[(i + n - 1) % n], line[i], line[i + 1])) taken.insert(line[i]);
}

/// Every n-th node of a stretch between taken ones.
void take_every(std::size_t n, const std::vector<int>& line, std::set<int>& taken) {
  std::size_t since = 0;
  for (const int node : line) {
    ++since;
    if (taken.contains(node) || since >= n) {
      taken.insert(node);
      since = 0;
    }
  }
}

std::vector<Edge> all_edges(const Mesh& mesh, int most_cells) {
  std::set<Edge> edges;
  int cells = 0;
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b) {
    if (info(mesh.blocks[at(b)].cell).dimension != 2) continue;
    cells += mesh.blocks[at(b)].count();
    if (cells > most_cells) return {};
    for (int i = 0; i < mesh.blocks[at(b)].count(); ++i)
      for (const Edge& edge : edges_of(mesh, {b, i})) edges.insert({std::min(edge[0], edge[1]), std::max(edge[0], edge[1])});
  }
  return {edges.begin(), edges.end()};
}

}  // namespace

MeshOutline outline_of(const Mesh& mesh, const std::vector<std::string>& groups, int most_nodes, int most_cells) {
  MeshOutline made;
  std::set<int> all, taken;
  for (const std::string& name : groups) {
    made.parts.push_back({name, boundary(mesh, mesh.groups.at(name))});
    for (const std::vector<int>& line : made.parts.back().lines) {
      all.insert(line.begin(), line.end());
      take_corners(mesh, line, taken);
    }
  }
  const std::size_t every = all.size() / at(std::max(most_nodes, 1)) + 1;
  for (const MeshOutline::Part& part : made.parts)
    for (const std::vector<int>& line : part.lines) take_every(every, line, taken);
  for (MeshOutline::Part& part : made.parts)
    for (std::vector<int>& line : part.lines) std::erase_if(line, [&](int node) { return !taken.contains(node); });
  made.nodes.assign(taken.begin(), taken.end());
  made.edges = all_edges(mesh, most_cells);
  return made;
}

}  // namespace uplift
