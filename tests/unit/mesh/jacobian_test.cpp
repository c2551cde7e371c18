#include "uplift/mesh/jacobian.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/mesh/mesh_support.h"
#include "uplift/io/mesh/gmsh.h"

namespace uplift::jacobian_test {
namespace {

using support::mesh_file;

Mesh unit_cell(Cell cell) {
  return info(cell).dimension == 2 ? rectangle({0, 1}, {0, 1}, cell) : box({0, 1}, {0, 1}, {0, 1}, cell);
}

std::vector<Cell> all_solid_cells() {
  std::vector<Cell> cells = support::plane_cells;
  cells.insert(cells.end(), support::space_cells.begin(), support::space_cells.end());
  return cells;
}

std::string refusal(const Mesh& mesh) {
  return support::mesh_refusal([&] { check_mesh(mesh, mesh_file); });
}

/// The node at a position; -1 when there is none.
int node_at(const Mesh& mesh, const Vec3& position) {
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    if ((mesh.nodes[i] - position).norm() < 1e-12) return static_cast<int>(i);
  return -1;
}

TEST(Jacobian, DistortedCellsAreAccepted) {
  // x + g(x) with |grad g| <= 0.15 * pi in every direction is a one-to-one map: no cell can fold
  std::mt19937 random(20261122);
  std::uniform_real_distribution<double> phase(0, 6.28);
  for (const Cell cell : all_solid_cells()) {
    const bool space = info(cell).dimension == 3;
    Mesh mesh = space ? box({0, 0.3, 1}, {0, 0.6, 1}, {0, 0.5, 1}, cell) : rectangle({0, 0.3, 1}, {0, 0.6, 1}, cell);
    const double a = phase(random), b = phase(random), c = phase(random);
    for (Vec3& x : mesh.nodes) {
      const Vec3 old = x;
      x.x() += 0.05 * std::sin(3.14 * old.y() + a);
      x.y() += 0.05 * std::sin(3.14 * old.x() + b);
      if (space) x.z() += 0.05 * std::sin(3.14 * old.x() + c);
    }
    EXPECT_EQ(refusal(mesh), "") << info(cell).name;
  }
}

TEST(Jacobian, SlenderAndNearlyDegenerateCellsAreAccepted) {
  for (const Cell cell : all_solid_cells()) {
    Mesh mesh = unit_cell(cell);
    for (Vec3& x : mesh.nodes) x = {1e4 * x.x(), x.y(), 1e-3 * x.z()};
    EXPECT_EQ(refusal(mesh), "") << info(cell).name;
  }
  Mesh mesh = unit_cell(Cell::quad4);
  mesh.nodes[node_at(mesh, {1, 1, 0})] = {0.501, 0.501, 0};  // an angle of 179.8 degrees
  EXPECT_EQ(refusal(mesh), "");
}

TEST(Jacobian, AConcaveCornerIsRefused) {
  // the edges at the moved corner are (-0.3, 0.7) and (0.7, -0.3): sine of the angle (0.09 - 0.49) / 0.58 = -0.6897
  Mesh quad = unit_cell(Cell::quad4);
  quad.nodes[node_at(quad, {1, 1, 0})] = {0.3, 0.3, 0};
  EXPECT_EQ(refusal(quad),
            "case.toml:7: mesh: expected cells with a positive Jacobian at every corner and integration point, found cell 1 of group "
            "\"volume\" (quad4 at (0.325, 0.325, 0)) with a scaled Jacobian of -0.6897 at its corner 3 at (0.3, 0.3, 0) m; such a cell "
            "is folded or turned over in part");
  Mesh hex = unit_cell(Cell::hex8);
  for (const double z : {0.0, 1.0}) hex.nodes[node_at(hex, {1, 1, z})] = {0.3, 0.3, z};
  EXPECT_NE(refusal(hex).find("(hex8 at (0.325, 0.325, 0.5)) with a scaled Jacobian of -0.6897 at its corner 3 at (0.3, 0.3, 0) m"),
            std::string::npos)
      << refusal(hex);
  // the top triangle is turned over, (0.2, -0.8) x (-0.8, 0.2) = -0.6 compared with 0.68, the bottom is not
  Mesh wedge;
  wedge.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.8, 0.8, 1}, {1, 0, 1}, {0, 1, 1}};
  wedge.block(Cell::wedge6).nodes = {0, 1, 2, 3, 4, 5};
  EXPECT_NE(refusal(wedge).find("with a scaled Jacobian of -0.8824 at its corner 5 at (1, 0, 1) m"), std::string::npos) << refusal(wedge);
}

TEST(Jacobian, AMiddleNodeBeyondACornerIsRefused) {
  // the parabola through 0, -0.5 and 1 runs backwards for the first three eighths of the edge: slope 8 s - 3
  for (const Cell cell : {Cell::tri6, Cell::quad8, Cell::quad9, Cell::tet10, Cell::wedge15, Cell::hex20, Cell::hex27}) {
    Mesh mesh = unit_cell(cell);
    mesh.nodes[node_at(mesh, {0.5, 0, 0})] = {-0.5, 0, 0};
    const std::string found = refusal(mesh);
    EXPECT_NE(found.find("at the integration point"), std::string::npos) << info(cell).name << found;
    mesh.nodes[node_at(mesh, {-0.5, 0, 0})] = {0.3, 0, 0};
    EXPECT_EQ(refusal(mesh), "") << info(cell).name;
  }
}

TEST(Jacobian, AFoldBetweenCornersIsFoundAtTheIntegrationPoints) {
  // y = (1 + s)/2 + 1.2 (1 - r^2)(1 - s)/2 turns back along s at r = 0 while all corners keep their right angles' sign
  for (const Cell cell : {Cell::quad8, Cell::hex20}) {
    Mesh mesh = unit_cell(cell);
    for (const double z : {0.0, 1.0})
      if (const int node = node_at(mesh, {0.5, 0, z}); node >= 0) mesh.nodes[node].y() = 1.2;
    EXPECT_NE(refusal(mesh).find("with a scaled Jacobian of -1 at the integration point (0.5, "), std::string::npos) << refusal(mesh);
  }
}

TEST(Jacobian, TheCellIsNamedByItsNumberInTheFile) {
  const std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"soil\"\n$EndPhysicalNames\n$Nodes\n6\n"
      "1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 1.3 0.3 0\n$EndNodes\n$Elements\n3\n"
      "17 15 2 0 1 1\n571 3 2 1 1 1 2 5 4\n803 3 2 1 1 2 3 6 5\n$EndElements\n";
  const Mesh mesh = read_gmsh(text, "soil.msh");
  const std::string found = support::mesh_refusal([&] { check_mesh(mesh, {"soil.msh", 0}); });
  EXPECT_EQ(found.substr(0, 15), "soil.msh: mesh:");
  EXPECT_NE(found.find("found cell 2 of group \"soil\" (quad4, number 803 in the mesh file, at (1.325, 0.325, 0)) with"), std::string::npos)
      << found;
  EXPECT_NE(found.find("corner 3 at (1.3, 0.3, 0) m"), std::string::npos) << found;
}

}  // namespace
}  // namespace uplift::jacobian_test
