#include "uplift/mesh/split.h"

#include <gtest/gtest.h>

#include "unit/mesh/split_support.h"
#include "uplift/mesh/soil_box.h"

namespace uplift::split_test {
namespace {

using namespace support;

/// Nodes of a plane patch of a x b faces of the type that the cell has there.
int patch_nodes(Cell cell, int a, int b) {
  const int corners = (a + 1) * (b + 1), edges = a * (b + 1) + (a + 1) * b, faces = a * b;
  switch (cell) {
    case Cell::tet10:
    case Cell::hex27:
      return corners + edges + faces;
    case Cell::hex20:
    case Cell::wedge15:
      return corners + edges;
    default:
      return corners;
  }
}
/// The same for the line in space with n edges.
int line_nodes(Cell cell, int n) {
  return cell == info(cell).linear ? n + 1 : 2 * n + 1;
}

TEST(Split, PlaneThroughTheBox) {
  for (const Cell cell : space_cells) {
    SCOPED_TRACE(info(cell).name);
    const auto left = [](int i, int, int) { return i < 2; };
    EXPECT_EQ(opened(parted({4, 3, 2}, left, cell), 2), patch_nodes(cell, 3, 2));
  }
  for (const Cell cell : plane_cells) {
    SCOPED_TRACE(info(cell).name);
    EXPECT_EQ(opened(parted(
                         {4, 3, 0}, [](int, int j, int) { return j < 1; }, cell),
                     2),
              line_nodes(cell, 4));
  }
}

/// The surface ends inside: its front stays single.
TEST(Split, PartOfAPlane) {
  const auto below = [](int, int, int k) { return k < 1; };
  for (const Cell cell : space_cells) {
    SCOPED_TRACE(info(cell).name);
    if (info(cell).linear == Cell::wedge6) continue;  // its faces here are triangles: below
    const int front = line_nodes(cell, 3);
    const auto up_to_2 = [](int i, int, int) { return i < 2; };
    EXPECT_EQ(opened(parted({4, 3, 2}, below, cell, up_to_2), 1), patch_nodes(cell, 2, 3) - front);
    const auto inside = [](int i, int j, int) { return i > 0 && i < 4 && j > 0 && j < 3; };  // 3 x 2 faces
    EXPECT_EQ(opened(parted({5, 4, 2}, below, cell, inside), 1),
              patch_nodes(cell, 3, 2) - 2 * (line_nodes(cell, 3) + line_nodes(cell, 2) - 2));
  }
  // Wedges: 15-node ones have the middles of the diagonals too, one for each of the 2 x 3 faces.
  const auto up_to_2 = [](int i, int, int) { return i < 2; };
  EXPECT_EQ(opened(parted({4, 3, 2}, below, Cell::wedge6, up_to_2), 1), 12 - 4);
  EXPECT_EQ(opened(parted({4, 3, 2}, below, Cell::wedge15, up_to_2), 1), 12 + 17 + 6 - 7);
  for (const Cell cell : plane_cells)
    EXPECT_EQ(opened(parted(
                         {5, 2, 0}, [](int, int j, int) { return j < 1; }, cell, [](int i, int, int) { return i > 0 && i < 4; }),
                     1),
              line_nodes(cell, 3) - 2);
}

/// Linear cells whose faces have all nodes on the rim of a strip one face wide; with 9-node faces the middles open.
TEST(Split, StripOneFaceWide) {
  const auto below = [](int, int, int k) { return k < 1; };
  const auto strip = [](int i, int, int) { return i == 1; };
  Mesh linear = parted({3, 2, 2}, below, Cell::hex8, strip);
  EXPECT_EQ(
      mesh_refusal([&] { split(linear, {"joint"}, {"soil"}, mesh_file); }),
      "case.toml:7: group \"joint\": expected a surface that can be opened, found one whose nodes all lie on its rim inside the mesh");
  EXPECT_EQ(opened(parted({3, 2, 2}, below, Cell::hex27, strip), 1), 2 + 3);  // middles of 2 faces and of 3 edges across the strip
}

TEST(Split, LShapedSurface) {
  for (const Cell cell : plane_cells) {
    SCOPED_TRACE(info(cell).name);
    const auto corner = [](int i, int j, int) { return i < 3 || j < 2; };  // all but the upper right
    EXPECT_EQ(opened(parted({5, 4, 0}, corner, cell), 2), line_nodes(cell, 2 + 2));
    const auto only_level = [](int, int j, int) { return j == 1; };  // one leg: the corner of the L is the front then
    EXPECT_EQ(opened(parted({5, 4, 0}, corner, cell, [&](int i, int j, int k) { return only_level(i, j, k) && i >= 3; }), 1),
              line_nodes(cell, 2) - 1);
  }
  for (const Cell cell : {Cell::hex8, Cell::hex20, Cell::hex27, Cell::tet4, Cell::tet10})
    EXPECT_EQ(opened(parted(
                         {4, 3, 4}, [](int i, int, int k) { return i < 2 || k < 2; }, cell),
                     2),
              2 * patch_nodes(cell, 2, 3) - line_nodes(cell, 3));
}

/// An inclusion in the middle: closed surface.
TEST(Split, ClosedSurface) {
  const auto outside = [](int i, int j, int k) { return !(i > 0 && i < 4 && j > 0 && j < 3 && k > 0 && k < 3); };
  EXPECT_EQ(opened(parted({5, 4, 4}, outside, Cell::hex8), 2), 4 * 3 * 3 - 2 * 1 * 1);
  EXPECT_EQ(opened(parted({5, 4, 4}, outside, Cell::hex27), 2), 7 * 5 * 5 - 5 * 3 * 3);
}

SoilBox small_model(int dimension, double embedment) {
  SoilBox model;
  model.dimension = dimension;
  model.cell = dimension == 2 ? Cell::quad4 : Cell::hex8;
  model.soil = {{24, 20}, {{3, 1}, {4, 2}}, 4};
  model.raft = {{8, 6}, 1, {0, 0}, 1};
  model.block = {{4, 4}, 5, {1, -1}, 1};
  model.embedment = embedment;
  return model;
}

std::vector<std::string> soil{"soil_1", "soil_2"};

/// Bottom and walls; the rim at the soil surface is doubled.
TEST(Split, EmbeddedRaft) {
  for (const double embedment : {0.0, 1.0, 2.0}) {
    for (const Cell cell : {Cell::quad4, Cell::quad9, Cell::tri6}) {
      SoilBox model = small_model(2, embedment);
      model.cell = cell;
      Mesh mesh = soil_box(model, mesh_file);
      const Mesh before = mesh;
      const auto surface = split(mesh, {"interface"}, soil, mesh_file)[0];
      expect_opened(before, mesh, surface, soil);
      expect_same_places(before, mesh);
      EXPECT_EQ(connected_pieces(mesh).count(), 2);
      // bottom 8 faces; at 2 m the walls of the raft (1 m), its ledges (8 - 4 m) and the walls of the block (1 m)
      const int faces = 8 + (embedment > 0 ? 2 : 0) + (embedment > 1 ? 4 + 2 : 0);
      EXPECT_EQ(surface.pairs.size(), static_cast<std::size_t>(line_nodes(cell, faces)));
    }
    for (const Cell cell : {Cell::hex8, Cell::hex20, Cell::tet4}) {
      SoilBox model = small_model(3, embedment);
      model.cell = cell;
      Mesh mesh = soil_box(model, mesh_file);
      const Mesh before = mesh;
      const auto surface = split(mesh, {"interface"}, soil, mesh_file)[0];
      expect_opened(before, mesh, surface, soil);
      EXPECT_EQ(connected_pieces(mesh).count(), 2);
      const int faces = 8 * 6 + (embedment > 0 ? 2 * (8 + 6) : 0) + (embedment > 1 ? 8 * 6 - 4 * 4 + 2 * (4 + 4) : 0);
      const int rim = embedment > 1 ? 2 * (4 + 4) : 2 * (8 + 6);  // edges; the surface is a disc: nodes = 1 + faces + rim / 2 (Euler)
      const int corners = 1 + faces + rim / 2, edges = (4 * faces + rim) / 2;
      EXPECT_EQ(surface.pairs.size(), static_cast<std::size_t>(cell == Cell::hex20 ? corners + edges : corners));
    }
  }
}

/// Two rafts on one soil, their walls and bottoms in groups of their own: in one call like one surface, one after another the corner stays
/// closed until its second surface is opened.
TEST(Split, SurfacesThatMeet) {
  const auto outside = [](int i, int j, int) { return !(i > 1 && i < 4 && j > 0); };
  Mesh base = parted({6, 3, 0}, outside, Cell::quad4);
  base.groups["bottom of it"] = base.groups["walls"] = Group{1, {}, {}};
  for (const CellId id : base.groups["joint"].cells)
    base.groups[std::abs(area_of(base, Cell::line2, base.cell(id)).y()) > 0.5 ? "bottom of it" : "walls"].cells.push_back(id);
  Mesh one = base, both = base, later = base;
  const auto whole = split(one, {"joint"}, {"soil"}, mesh_file)[0];
  const auto parts = split(both, {"bottom of it", "walls"}, {"soil"}, mesh_file);
  EXPECT_EQ(one.nodes.size(), both.nodes.size());
  EXPECT_EQ(whole.pairs.size(), 2u + 2 + 2 + 1);
  EXPECT_EQ(parts[0].pairs.size(), 3u);  // the corners belong to bottom and wall
  EXPECT_EQ(parts[1].pairs.size(), 6u);
  for (const auto& part : parts) expect_opened(base, both, part, {"soil"});

  const auto first = split(later, {"bottom of it"}, {"soil"}, mesh_file)[0];
  EXPECT_EQ(first.pairs.size(), 1u);
  EXPECT_EQ(connected_pieces(later).count(), 1);
  const auto second = split(later, {"walls"}, {"soil"}, mesh_file)[0];
  EXPECT_EQ(connected_pieces(later).count(), 2);
  EXPECT_EQ(second.pairs.size(), 6u);
  EXPECT_EQ(pairs_of(later, first.faces).size(), 3u);  // the corners opened with the walls
  EXPECT_EQ(later.nodes.size(), one.nodes.size());
}

/// Two planes that cross, one after the other, in the same mesh: four blocks.
TEST(Split, CrossingSurfaces) {
  for (const Cell cell : {Cell::hex8, Cell::hex20, Cell::hex27, Cell::tet10}) {
    const std::vector<double> x = uniform_lines(0, 4, 4), y = uniform_lines(0, 3, 3), z = uniform_lines(0, 5, 5);
    const auto part = [](int i, int, int k) { return (i < 2 ? 0 : 1) + (k < 2 ? 0 : 2); };
    Mesh mesh = with_cells(grid({x, y, z}, part, {"a", "b", "c", "d"},
                                [](int p, Direction direction, int other) -> std::string {
                                  if (other < 0) return std::string(name_of(direction));
                                  if (p < other) return direction == Direction::right ? "upright" : "level";
                                  return "";
                                }),
                           cell);
    const auto upright = split(mesh, {"upright"}, {"a", "c"}, mesh_file)[0];
    EXPECT_EQ(upright.pairs.size(), static_cast<std::size_t>(patch_nodes(cell, 3, 5)));
    const Mesh before = mesh;
    const auto level = split(mesh, {"level"}, {"a", "b"}, mesh_file)[0];
    expect_opened(before, mesh, level, {"a", "b"});
    expect_same_places(before, mesh);
    EXPECT_EQ(connected_pieces(mesh).count(), 4);
    EXPECT_EQ(level.pairs.size(), static_cast<std::size_t>(2 * patch_nodes(cell, 2, 3)));
    EXPECT_EQ(pairs_of(mesh, upright.faces).size(), static_cast<std::size_t>(patch_nodes(cell, 3, 2) + patch_nodes(cell, 3, 3)));
  }
}

/// The same three sides in another way: raft off the soil, then block off the raft, with the rims of both on one line.
TEST(Split, BlockOnRaftOnSoil) {
  const auto part = [](int, int j, int) { return j < 2 ? 0 : j < 3 ? 1 : 2; };
  Mesh mesh = grid({uniform_lines(0, 3, 3), uniform_lines(0, 5, 5), {}}, part, {"soil", "raft", "block"},
                   [](int p, Direction, int other) -> std::string { return p < other ? p == 0 ? "base" : "joint" : ""; });
  split(mesh, {"base"}, {"soil"}, mesh_file);
  const auto joint = split(mesh, {"joint"}, {"soil", "raft"}, mesh_file)[0];
  EXPECT_EQ(joint.pairs.size(), 4u);
  EXPECT_EQ(connected_pieces(mesh).count(), 3);
}

/// Middles of edges open first, their corners with the rest of the plane: faces that share their corners are not one face.
TEST(Split, StripThenTheRest) {
  for (const Cell cell : {Cell::hex20, Cell::hex27}) {
    Mesh mesh = parted(
        {3, 2, 2}, [](int, int, int k) { return k < 1; }, Cell::hex8);
    Group strip{2, {}, {}}, rest{2, {}, {}};
    for (const CellId id : mesh.groups["joint"].cells) (std::abs(centre(mesh, id).x() - 1.5) < 0.1 ? strip : rest).cells.push_back(id);
    mesh.groups["strip"] = strip;
    mesh.groups["beside"] = rest;
    mesh = with_cells(mesh, cell);
    const std::size_t nodes = mesh.nodes.size();
    split(mesh, {"strip"}, {"soil"}, mesh_file);
    EXPECT_EQ(mesh.nodes.size(), nodes + (cell == Cell::hex20 ? 3 : 5));
    split(mesh, {"beside"}, {"soil"}, mesh_file);
    EXPECT_EQ(mesh.nodes.size(), nodes + patch_nodes(cell, 3, 2));
    EXPECT_EQ(connected_pieces(mesh).count(), 2);
  }
}

}  // namespace
}  // namespace uplift::split_test
