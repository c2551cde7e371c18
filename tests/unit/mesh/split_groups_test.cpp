#include <gtest/gtest.h>

#include "unit/mesh/split_support.h"

// What goes with which side, surfaces that touch themselves, requests that cannot be met.
namespace uplift::split_groups_test {
namespace {

using namespace support;

/// Beams, points, node groups and faces of other groups.
TEST(Split, WhatHangsOnTheSurface) {
  Mesh base = parted(
      {2, 2, 0}, [](int, int j, int) { return j < 1; }, Cell::quad4);  // nodes 0 1 2 / 3 4 5 / 6 7 8
  base.nodes.emplace_back(1, 3, 0);
  base.nodes.emplace_back(1, -1, 0);
  auto& lines = base.block(Cell::line2);
  const int first = lines.count(), block = base.find_block(Cell::line2);
  lines.nodes.insert(lines.nodes.end(), {4, 9, 4, 10, 3, 4});  // a mast, a pile, a strip along the surface
  base.groups["mast"] = {1, {{block, first}}, {}};
  base.groups["pile"] = {1, {{block, first + 1}}, {}};
  base.groups["strip"] = {1, {{block, first + 2}}, {}};
  base.block(Cell::point).nodes = {4, 5};
  const int points = base.find_block(Cell::point);
  base.groups["mass"] = {0, {{points, 0}}, {}};
  base.groups["anchor"] = {0, {{points, 1}}, {}};
  base.groups["watched"] = {0, {}, {0, 3, 8}};

  Mesh mesh = base;
  const auto surface = split(mesh, {"joint"}, {"soil", "pile", "anchor"}, mesh_file)[0];
  EXPECT_EQ(surface.pairs, (std::vector<NodePair>{{3, 11}, {4, 12}, {5, 13}}));
  const auto nodes = [&](const std::string& group) { return nodes_of(mesh, mesh.groups.at(group)); };
  EXPECT_EQ(nodes("mast"), (std::vector<int>{9, 12}));
  EXPECT_EQ(nodes("pile"), (std::vector<int>{4, 10}));
  EXPECT_EQ(nodes("strip"), (std::vector<int>{11, 12}));
  EXPECT_EQ(nodes("mass"), (std::vector<int>{12}));
  EXPECT_EQ(nodes("anchor"), (std::vector<int>{5}));
  EXPECT_EQ(nodes("watched"), (std::vector<int>{0, 3, 8, 11}));
  EXPECT_EQ(nodes("joint"), (std::vector<int>{3, 4, 5}));
  EXPECT_EQ(nodes("joint_upper"), (std::vector<int>{11, 12, 13}));
  EXPECT_EQ(nodes("left"), (std::vector<int>{0, 3, 6, 11}));
  EXPECT_EQ(nodes("soil"), (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

/// Cells that touch in one node only stay together on either side: the surface does not part them.
TEST(Split, SidesThatTouchInANode) {
  const auto chess = [](int i, int j, int) { return (i + j) % 2 == 0; };
  EXPECT_EQ(opened(parted({2, 2, 0}, chess, Cell::quad4), 2), 5);  // the four faces have the middle and four ends
}

/// Of four cells around a node only one is cut out; the other three, of both sides, stay together. The single one is on the lower or on the
/// upper side.
TEST(Split, OneOfFourCells) {
  const auto chess = [](int i, int j, int) { return (i + j) % 2 == 0; };
  for (const bool lower_one : {true, false}) {
    Mesh mesh = parted({2, 2, 0}, chess, Cell::quad4);
    const Vec3 one = lower_one ? Vec3(0.5, 0.5, 0) : Vec3(1.5, 0.5, 0);
    std::erase_if(mesh.groups["joint"].cells, [&](CellId id) { return (centre(mesh, id) - one).norm() > 0.6; });
    ASSERT_EQ(mesh.groups["joint"].cells.size(), 2u);
    const Mesh before = mesh;
    const auto surface = split(mesh, {"joint"}, {"soil"}, mesh_file)[0];
    EXPECT_EQ(mesh.nodes.size(), before.nodes.size() + 3);
    EXPECT_EQ(surface.pairs,
              (lower_one ? std::vector<NodePair>{{1, 9}, {3, 10}, {4, 11}} : std::vector<NodePair>{{1, 9}, {4, 10}, {5, 11}}));
    EXPECT_EQ(connected_pieces(mesh).count(), 2);
    expect_opened(before, mesh, surface, {"soil"});
  }
}

/// Around the middle node lower and upper cells alternate. With one of the four faces closed, a lower, an upper and a joined sector meet.
TEST(Split, BranchingSurfaceIsRefused) {
  const auto chess = [](int i, int j, int) { return (i + j) % 2 == 0; };
  Mesh mesh = parted({2, 2, 0}, chess, Cell::quad4);
  mesh.groups["joint"].cells.pop_back();
  const Mesh before = mesh;
  EXPECT_EQ(mesh_refusal([&] { split(mesh, {"joint"}, {"soil"}, mesh_file); }),
            "case.toml:7: group \"joint\": expected a surface with two sides at each of its nodes, found one that branches at (1, 1, 0)");
  EXPECT_EQ(mesh.nodes.size(), before.nodes.size());
  EXPECT_EQ(mesh.groups.size(), before.groups.size());
}

TEST(Split, WrongRequests) {
  const Mesh base = parted(
      {2, 2, 0}, [](int, int j, int) { return j < 1; }, Cell::quad4);
  const auto refusal = [&](const std::vector<std::string>& surfaces, const std::vector<std::string>& lower, Mesh mesh) {
    return mesh_refusal([&] { split(mesh, surfaces, lower, mesh_file); });
  };
  EXPECT_EQ(refusal({"jiont"}, {"soil"}, base),
            "case.toml:7: expected the surface to open, found no group \"jiont\" in the mesh (did you mean \"joint\"?)");
  EXPECT_EQ(refusal({"joint"}, {"soli"}, base),
            "case.toml:7: expected the lower side of the surface, found no group \"soli\" in the mesh (did you mean \"soil\"?)");
  EXPECT_EQ(refusal({"joint"}, {}, base), "case.toml:7: expected a group of the lower side with cells of dimension 2, found no group");
  EXPECT_EQ(refusal({"joint"}, {"left"}, base),
            "case.toml:7: expected a group of the lower side with cells of dimension 2, found none in \"left\"");
  EXPECT_EQ(refusal({"rest"}, {"soil"}, base), "case.toml:7: group \"rest\": expected a group of lines, found cells of dimension 2");
  const std::string between = "expected faces between a cell of the lower side and one of the upper side, found ";
  EXPECT_EQ(refusal({"left"}, {"soil"}, base),
            "case.toml:7: group \"left\": " + between +
                "2 of 2 elsewhere; the first, cell 1 of group \"left\" (line2 at (0, 0.5, 0)), lies on the outer boundary");
  EXPECT_EQ(refusal({"joint"}, {"soil", "rest"}, base),
            "case.toml:7: group \"joint\": " + between +
                "2 of 2 elsewhere; the first, cell 1 of group \"joint\" (line2 at (0.5, 1, 0)), has the lower side on both sides");
  EXPECT_EQ(refusal({"joint", "joint"}, {"soil"}, base), "case.toml:7: group \"joint\": expected each surface once, found it twice");

  Mesh loose = base;
  auto& lines = loose.block(Cell::line2);
  loose.groups["joint"].cells.push_back({loose.find_block(Cell::line2), lines.count()});
  lines.nodes.insert(lines.nodes.end(), {0, 4});
  EXPECT_NE(refusal({"joint"}, {"soil"}, loose)
                .find("1 of 3 elsewhere; the first, cell 3 of group \"joint\" (line2 at (0.5, 0.5, 0)), belongs to no cell of dimension 2"),
            std::string::npos);
  Mesh twice = base;
  twice.groups["again"] = twice.groups["joint"];
  EXPECT_NE(refusal({"joint", "again"}, {"soil"}, twice).find("lies on another one of them"), std::string::npos);
  Mesh open = base;
  split(open, {"joint"}, {"soil"}, mesh_file);
  EXPECT_EQ(refusal({"joint"}, {"soil"}, open),
            "case.toml:7: group \"joint\": expected a surface that is not open yet, found the group \"joint_upper\" in the mesh");
  Mesh overlap = base;
  auto& quads = overlap.block(Cell::quad4);
  quads.nodes.insert(quads.nodes.end(), {3, 4, 7, 6});
  EXPECT_NE(refusal({"joint"}, {"soil"}, overlap).find("expected faces between two cells, found more than two cells at a face of "),
            std::string::npos);
}

}  // namespace
}  // namespace uplift::split_groups_test
