#include "uplift/mesh/convert.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <functional>

#include "uplift/mesh/index.h"
#include "uplift/mesh/sides.h"

namespace uplift {
namespace {

/// Puts cells into a mesh and remembers which new cells came from an old one.
class Replacement {
 public:
  explicit Replacement(const Mesh& old) : old_(old) {
    made.dimension = old.dimension;
    made.nodes = old.nodes;
    for (const CellBlock& block : old.blocks) made_of_.emplace_back(at(block.count()));
  }
  void add(CellId from, Cell cell, std::span<const int> nodes) {
    CellBlock& block = made.block(cell);
    Made& cells = made_of_[at(from.block)][at(from.index)];
    if (cells.count++ == 0) cells.first = {made.find_block(cell), block.count()};
    block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
  }
  Mesh finish() {
    for (const auto& [name, group] : old_.groups) {
      Group& now = made.groups[name];
      now.dimension = group.dimension;
      now.nodes = group.nodes;
      for (const CellId id : group.cells) {
        const Made& cells = made_of_[at(id.block)][at(id.index)];
        for (int i = 0; i < cells.count; ++i) now.cells.push_back({cells.first.block, cells.first.index + i});
      }
      std::sort(now.cells.begin(), now.cells.end());
    }
    return std::move(made);
  }
  Mesh made;

 private:
  struct Made {  // cells made of one: all of one type, one after another
    CellId first;
    int count = 0;
  };
  const Mesh& old_;
  std::vector<std::vector<Made>> made_of_;
};

/// Calls act(id, type, nodes) for every cell.
template <class Act>
void for_each_cell(const Mesh& mesh, Act&& act) {
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b)
    for (int i = 0; i < mesh.blocks[at(b)].count(); ++i) {
      const CellInfo& type = info(mesh.blocks[at(b)].cell);
      assert(type.nodes == type.corners);
      act(CellId{b, i}, type, mesh.blocks[at(b)][i]);
    }
}

/// Triangles of a polygon with three or four corners, through its lowest node, with the same turn.
void cut_face(std::span<const int> nodes, const std::function<void(int, int, int)>& act) {
  const auto n = nodes.size();
  const auto low = static_cast<std::size_t>(std::min_element(nodes.begin(), nodes.end()) - nodes.begin());
  for (std::size_t i = 1; i + 1 < n; ++i) act(nodes[low], nodes[(low + i) % n], nodes[(low + i + 1) % n]);
}

/// Tetrahedra from the lowest node of a volume to the triangles of the sides that do not have it.
void cut_volume(const CellInfo& type, std::span<const int> nodes, const std::function<void(int, int, int, int)>& act) {
  const int apex = *std::min_element(nodes.begin(), nodes.end());
  for (int s = 0; s < static_cast<int>(type.sides.size()); ++s) {
    std::vector<int> side;
    for (const int i : side_of(type.cell, s)) side.push_back(nodes[at(i)]);
    if (std::find(side.begin(), side.end(), apex) != side.end()) continue;
    cut_face(side, [&](int a, int b, int c) { act(a, c, b, apex); });  // turned round: seen from the apex
  }
}

/// Numbers of new nodes, in the order in which they are first met.
class Middles {
 public:
  explicit Middles(Mesh& mesh) : mesh_(mesh), edges_(mesh.nodes.size()), faces_(mesh.nodes.size()) {}
  int edge(int a, int b) { return node(edges_, edge_nodes_, std::array{a, b}); }
  int face(std::span<const int> corners) { return node(faces_, face_nodes_, corners); }
  int centre(std::span<const int> corners) {
    Vec3 sum = Vec3::Zero();
    for (const int c : corners) sum += mesh_.nodes[at(c)];
    mesh_.nodes.push_back(sum / static_cast<double>(corners.size()));
    return static_cast<int>(mesh_.nodes.size()) - 1;
  }

 private:
  int node(NodeSets& sets, std::vector<int>& nodes, std::span<const int> corners) {
    const int set = sets.insert(corners);
    if (set == static_cast<int>(nodes.size())) nodes.push_back(centre(corners));
    return nodes[at(set)];
  }
  Mesh& mesh_;
  NodeSets edges_, faces_;
  std::vector<int> edge_nodes_, face_nodes_;
};

Cell second_degree(Cell cell, bool full) {
  switch (cell) {
    case Cell::line2:
      return Cell::line3;
    case Cell::tri3:
      return Cell::tri6;
    case Cell::quad4:
      return full ? Cell::quad9 : Cell::quad8;
    case Cell::tet4:
      return Cell::tet10;
    case Cell::wedge6:
      return Cell::wedge15;
    case Cell::hex8:
      return full ? Cell::hex27 : Cell::hex20;
    default:
      return cell;
  }
}

}  // namespace

Mesh to_simplices(const Mesh& mesh) {
  Replacement result(mesh);
  for_each_cell(mesh, [&](CellId id, const CellInfo& type, std::span<const int> nodes) {
    if (type.cell == Cell::quad4)
      cut_face(nodes, [&](int a, int b, int c) { result.add(id, Cell::tri3, std::array{a, b, c}); });
    else if (type.cell == Cell::hex8 || type.cell == Cell::wedge6)
      cut_volume(type, nodes, [&](int a, int b, int c, int d) { result.add(id, Cell::tet4, std::array{a, b, c, d}); });
    else
      result.add(id, type.cell, nodes);
  });
  return result.finish();
}

Mesh to_wedges(const Mesh& mesh) {
  constexpr int bottom = 4, top = 5;  // sides of bricks
  Replacement result(mesh);
  const Sides sides(mesh, full_cells(mesh));
  const auto corners = [&](int side, std::array<int, 4> which) {
    const auto nodes = mesh.cell(sides.cells()[at(side / Sides::stride)]);
    return std::array{nodes[at(which[0])], nodes[at(which[1])], nodes[at(which[2])], nodes[at(which[3])]};
  };
  for_each_cell(mesh, [&](CellId id, const CellInfo& type, std::span<const int> n) {
    if (type.cell == Cell::hex8) {
      result.add(id, Cell::wedge6, std::array{n[0], n[1], n[2], n[4], n[5], n[6]});
      result.add(id, Cell::wedge6, std::array{n[0], n[2], n[3], n[4], n[6], n[7]});
      return;
    }
    const int side = type.cell == Cell::quad4 ? sides.find(type.cell, n) : -1;
    if (side < 0 || (side % Sides::stride != bottom && side % Sides::stride != top)) return result.add(id, type.cell, n);
    const auto q = side % Sides::stride == bottom ? corners(side, {0, 3, 2, 1}) : corners(side, {4, 5, 6, 7});
    const bool turned =
        n[(at(static_cast<int>(std::find(n.begin(), n.end(), q[0]) - n.begin())) + 1) % 4] != q[1];  // seen from the other cell
    const auto add = [&](int a, int b, int c) { result.add(id, Cell::tri3, turned ? std::array{a, c, b} : std::array{a, b, c}); };
    add(q[0], q[1], q[2]);
    add(q[0], q[2], q[3]);
  });
  return result.finish();
}

Mesh to_second_degree(const Mesh& mesh, bool full) {
  Replacement result(mesh);
  Middles middles(result.made);
  std::vector<int> all, corners;
  for_each_cell(mesh, [&](CellId id, const CellInfo& type, std::span<const int> nodes) {
    assert(!full || type.cell != Cell::wedge6);
    all.assign(nodes.begin(), nodes.end());
    if (type.dimension > 0)
      for (std::size_t e = 0; e < type.edges.size(); e += 2)
        all.push_back(middles.edge(nodes[at(type.edges[e])], nodes[at(type.edges[e + 1])]));
    if (full && type.cell == Cell::quad4) all.push_back(middles.face(nodes));
    if (full && type.cell == Cell::hex8) {
      for (int s = 0; s < 6; ++s) {
        corners.clear();
        for (const int i : side_of(type.cell, s)) corners.push_back(nodes[at(i)]);
        all.push_back(middles.face(corners));
      }
      all.push_back(middles.centre(nodes));
    }
    result.add(id, second_degree(type.cell, full), all);
  });
  return result.finish();
}

}  // namespace uplift
