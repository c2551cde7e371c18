#include <gtest/gtest.h>

#include <cmath>

#include "unit/mesh/mesh_support.h"
#include "uplift/mesh/soil_box.h"

namespace uplift::check_test {
namespace {

using support::mesh_file;

std::string refusal(const Mesh& mesh) {
  return support::mesh_refusal([&] { check_mesh(mesh, mesh_file); });
}
Mesh two_quads() {
  return rectangle({0, 1, 2}, {0, 1});
}

TEST(CheckMesh, TakesEveryBox) {
  for (const Cell cell : support::plane_cells) EXPECT_EQ(refusal(rectangle({0, 1, 3}, {-1, 0, 2}, cell)), "");
  for (const Cell cell : support::space_cells) EXPECT_EQ(refusal(box({0, 1, 3}, {-1, 0, 2}, {0, 1}, cell)), "");
}

TEST(CheckMesh, NodesOutOfRange) {
  Mesh mesh = two_quads();
  mesh.block(Cell::quad4).nodes[5] = 6;
  EXPECT_EQ(refusal(mesh), "case.toml:7: mesh: expected nodes from 1 to 6, found node 7 in quad4 2");
  mesh.block(Cell::quad4).nodes[5] = -1;
  EXPECT_EQ(refusal(mesh), "case.toml:7: mesh: expected nodes from 1 to 6, found node 0 in quad4 2");
  mesh.block(Cell::quad4).nodes.pop_back();
  EXPECT_EQ(refusal(mesh), "case.toml:7: mesh: expected 4 nodes for each quad4, found 7 nodes in all");
}

TEST(CheckMesh, Coordinates) {
  Mesh mesh = two_quads();
  mesh.nodes[3].y() = NAN;
  EXPECT_EQ(refusal(mesh), "case.toml:7: mesh: expected finite coordinates, found node 4 at (0, nan, 0)");
  mesh = two_quads();
  mesh.nodes[3].z() = 1e-300;
  EXPECT_NE(refusal(mesh).find("expected one plane z = 0, found node 4"), std::string::npos);
  mesh.dimension = 3;
  EXPECT_EQ(refusal(mesh), "");
}

TEST(CheckMesh, CellsNamedByGroupAndNumber) {
  const std::string wanted =
      "case.toml:7: mesh: expected cells with different nodes and a positive size, found cell 2 of group \"volume\" (quad4 at ";
  Mesh mesh = two_quads();
  std::swap(mesh.block(Cell::quad4).nodes[4], mesh.block(Cell::quad4).nodes[6]);  // clockwise
  EXPECT_EQ(refusal(mesh), wanted + "(1.5, 0.5, 0)) that is inside out");
  mesh = two_quads();
  mesh.block(Cell::quad4).nodes[4] = mesh.block(Cell::quad4).nodes[6];
  EXPECT_NE(refusal(mesh).find("that has a node twice"), std::string::npos);
  mesh = two_quads();
  for (int i = 4; i < 8; ++i) mesh.nodes[mesh.block(Cell::quad4).nodes[i]].y() = 0;
  EXPECT_NE(refusal(mesh).find("(quad4 at (1.5, 0, 0)) that has no size, and 1 more such cells"), std::string::npos) << refusal(mesh);
  mesh = box({0, 1, 2}, {0, 1}, {0, 1}, Cell::tet4);
  std::swap(mesh.block(Cell::tet4).nodes[40], mesh.block(Cell::tet4).nodes[41]);
  EXPECT_NE(refusal(mesh).find("found cell 11 of group \"volume\" (tet4"), std::string::npos) << refusal(mesh);
  EXPECT_NE(refusal(mesh).find("inside out"), std::string::npos);
}

TEST(CheckMesh, Groups) {
  Mesh mesh = two_quads();
  mesh.groups["left"].cells.push_back({1, 99});
  EXPECT_EQ(refusal(mesh), "case.toml:7: group \"left\": expected cells of the mesh, found cell 99 of block 1");
  mesh = two_quads();
  mesh.groups["left"].cells.insert(mesh.groups["left"].cells.begin(), {0, 0});
  EXPECT_EQ(refusal(mesh), "case.toml:7: group \"left\": expected cells of dimension 1, found a quad4");
  mesh = two_quads();
  std::swap(mesh.groups["volume"].cells[0], mesh.groups["volume"].cells[1]);
  EXPECT_NE(refusal(mesh).find("group \"volume\": expected cells in ascending order"), std::string::npos);
  mesh = two_quads();
  mesh.groups["corner"].nodes = {2, 6};
  EXPECT_EQ(refusal(mesh), "case.toml:7: group \"corner\": expected nodes of the mesh, found node 6");
}

TEST(CheckMesh, PlaneMeshesHoldNoVolumes) {
  Mesh mesh = box({0, 1}, {0, 1}, {0, 1});
  for (Vec3& x : mesh.nodes) x.z() = 0;
  mesh.dimension = 2;
  EXPECT_EQ(refusal(mesh), "case.toml:7: mesh: expected cells of a plane mesh, found hex8");
  mesh.dimension = 4;
  EXPECT_EQ(refusal(mesh), "case.toml:7: mesh: expected dimension 2 or 3, found 4");
}

TEST(Groups, NodesOfCellsAndOwn) {
  Mesh mesh = two_quads();  // nodes 0 1 2 / 3 4 5
  EXPECT_EQ(nodes_of(mesh, mesh.groups.at("right")), (std::vector<int>{2, 5}));
  EXPECT_EQ(nodes_of(mesh, mesh.groups.at("top")), (std::vector<int>{3, 4, 5}));
  EXPECT_EQ(nodes_of(mesh, Group{0, {}, {1, 4}}), (std::vector<int>{1, 4}));
  EXPECT_EQ(mesh.cells(), 8);
  EXPECT_EQ(mesh.find_block(Cell::tri3), -1);
}

}  // namespace
}  // namespace uplift::check_test
