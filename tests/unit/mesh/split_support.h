#pragma once
#include <gtest/gtest.h>

#include "unit/mesh/mesh_support.h"
#include "uplift/mesh/quality.h"
#include "uplift/mesh/split.h"

// Grids with a surface to open, and what must hold after any split.
namespace uplift::support {

/// Unit cells; part 0 "soil" below, part 1 "rest"; the faces between them in "joint" where `on` says so (asked with the cell of the soil).
inline Mesh parted(
    std::array<int, 3> n, const std::function<bool(int, int, int)>& is_soil, Cell cell,
    const std::function<bool(int, int, int)>& on = [](int, int, int) { return true; }) {
  const Grid lines{uniform_lines(0, n[0], n[0]), uniform_lines(0, n[1], n[1]), n[2] ? uniform_lines(0, n[2], n[2]) : std::vector<double>{}};
  const auto part = [&](int i, int j, int k) { return is_soil(i, j, k) ? 0 : 1; };
  Mesh mesh = grid(lines, part, {"soil", "rest"}, [](int p, Direction direction, int other) {
    if (other < 0) return std::string(name_of(direction));
    return p == 0 ? std::string("joint") : std::string();
  });
  auto& joint = mesh.groups["joint"];
  std::erase_if(joint.cells, [&](CellId id) {
    const Vec3 inside = centre(mesh, id) - area_of(mesh, mesh.type(id), mesh.cell(id)) / 2;  // the middle of the soil's cell
    return !on(static_cast<int>(inside.x()), static_cast<int>(inside.y()), static_cast<int>(inside.z()));
  });
  return with_cells(mesh, cell);
}

/// Everything that must hold after any split, judged without mesh/split.cpp: nodes, faces, groups, places.
inline void expect_opened(const Mesh& before, const Mesh& after, const OpenedSurface& surface, const std::vector<std::string>& lower) {
  check_mesh(after, mesh_file);
  std::vector<CellId> lower_cells;
  for (const std::string& name : lower)
    for (const CellId id : after.groups.at(name).cells) lower_cells.push_back(id);
  std::sort(lower_cells.begin(), lower_cells.end());
  const auto is_lower = [&](CellId id) { return std::binary_search(lower_cells.begin(), lower_cells.end(), id); };
  const auto sides = side_map(after);
  const Group &below = after.groups.at(surface.name), &above = after.groups.at(surface.name + "_upper");
  EXPECT_EQ(below.cells, before.groups.at(surface.name).cells);
  EXPECT_EQ(above.cells.size(), below.cells.size());
  EXPECT_EQ(above.dimension, after.dimension - 1);
  ASSERT_EQ(surface.faces.size(), below.cells.size());
  std::vector<NodePair> pairs;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const FacePair& face = surface.faces[f];
    EXPECT_EQ(face.lower, below.cells[f]);
    EXPECT_TRUE(std::binary_search(above.cells.begin(), above.cells.end(), face.upper));
    ASSERT_EQ(after.type(face.lower), after.type(face.upper));
    EXPECT_EQ(sorted_nodes(before, face.lower), sorted_nodes(after, face.lower));
    const auto low = after.cell(face.lower), up = after.cell(face.upper);
    const Vec3 normal = area_of(after, after.type(face.lower), low);
    for (std::size_t i = 0; i < low.size(); ++i) {
      EXPECT_EQ(after.nodes[low[i]], after.nodes[up[i]]);
      if (low[i] != up[i]) pairs.push_back({low[i], up[i]});
    }
    const auto under = sides.find(sorted_nodes(after, face.lower)), over = sides.find(sorted_nodes(after, face.upper));
    ASSERT_TRUE(under != sides.end() && over != sides.end());
    if (under == over) continue;  // all nodes on the rim
    ASSERT_EQ(under->second.size(), 1u);
    ASSERT_EQ(over->second.size(), 1u);
    EXPECT_TRUE(is_lower(under->second[0]));
    EXPECT_FALSE(is_lower(over->second[0]));
    EXPECT_GT(normal.dot(centre(after, face.lower) - centre(after, under->second[0])), 0);
    EXPECT_LT(normal.dot(centre(after, face.lower) - centre(after, over->second[0])), 0);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  EXPECT_EQ(surface.pairs, pairs);
  for (std::size_t i = 1; i < pairs.size(); ++i) EXPECT_NE(pairs[i].lower, pairs[i - 1].lower);
}

/// Every face in a group still belongs to a cell, and cells are where they were.
inline void expect_same_places(const Mesh& before, const Mesh& after) {
  const auto sides = side_map(after);
  for (int b = 0; b < static_cast<int>(before.blocks.size()); ++b)
    for (int i = 0; i < before.blocks[b].count(); ++i) {
      const CellId id{b, i};
      EXPECT_EQ(centre(before, id), centre(after, id));
      if (info(after.type(id)).dimension == after.dimension - 1)
        EXPECT_TRUE(sides.contains(sorted_nodes(after, id))) << describe_cell(after, id);
    }
}

/// Opens "joint" and checks all that; how many nodes were doubled.
inline int opened(Mesh mesh, int pieces, const std::vector<std::string>& lower = {"soil"}) {
  const Mesh before = mesh;
  const auto surfaces = split(mesh, {"joint"}, lower, mesh_file);
  EXPECT_EQ(surfaces.size(), 1u);
  expect_opened(before, mesh, surfaces[0], lower);
  expect_same_places(before, mesh);
  EXPECT_EQ(connected_pieces(mesh).count(), pieces);
  const int doubled = static_cast<int>(mesh.nodes.size() - before.nodes.size());
  EXPECT_EQ(surfaces[0].pairs.size(), static_cast<std::size_t>(doubled));
  return doubled;
}

}  // namespace uplift::support
