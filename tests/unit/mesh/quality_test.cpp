#include "uplift/mesh/quality.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/mesh/mesh_support.h"
#include "uplift/mesh/convert.h"

namespace uplift::quality_test {
namespace {

using namespace support;

Mesh one(Cell cell, int dimension, std::vector<Vec3> nodes) {
  Mesh mesh;
  mesh.dimension = dimension;
  mesh.nodes = std::move(nodes);
  for (int i = 0; i < info(cell).nodes; ++i) mesh.block(cell).nodes.push_back(i);
  mesh.groups["all"] = {info(cell).dimension, {{0, 0}}, {}};
  return mesh;
}

const double root_3 = std::sqrt(3.0);

/// Ideal cells have 1: equilateral triangle, regular tetrahedron, wedge of equilateral triangles with square walls, square, cube.
TEST(Quality, IdealCells) {
  const std::vector<Vec3> tri{{0, 0, 0}, {1, 0, 0}, {0.5, root_3 / 2, 0}};
  std::vector<Vec3> wedge = tri, tet = tri;
  for (const Vec3& x : tri) wedge.push_back(x + Vec3(0, 0, 1));
  tet.emplace_back(0.5, root_3 / 6, std::sqrt(2.0 / 3));
  const std::vector<Mesh> all{one(Cell::tri3, 2, tri), one(Cell::tet4, 3, tet), one(Cell::wedge6, 3, wedge), rectangle({0, 1}, {0, 1}),
                              box({0, 1}, {0, 1}, {0, 1})};
  for (const Mesh& mesh : all)
    for (const bool second : {false, true}) {
      const Mesh now = second ? to_second_degree(mesh, false) : mesh;
      const CellQuality q = quality(now, {0, 0});
      EXPECT_NEAR(q.jacobian, 1, 1e-14) << info(now.blocks[0].cell).name;
      EXPECT_NEAR(q.shortest, 1, 1e-14);
      EXPECT_NEAR(q.longest, 1, 1e-14);
      EXPECT_NEAR(q.aspect, 1, 1e-14);
    }
}

/// A parallelogram with the angle a has sin a at all corners, whatever the lengths; turned over it has - sin a.
TEST(Quality, Parallelogram) {
  for (const double a : {0.3, 1.0, 2.0}) {
    const Vec3 u{2, 0, 0}, v{5 * std::cos(a), 5 * std::sin(a), 0};
    const Mesh mesh = one(Cell::quad4, 2, {{0, 0, 0}, u, u + v, v});
    const CellQuality q = quality(mesh, {0, 0});
    EXPECT_NEAR(q.jacobian, std::sin(a), 1e-14);
    EXPECT_NEAR(q.shortest, 2, 1e-14);
    EXPECT_NEAR(q.longest, 5, 1e-14);
    EXPECT_NEAR(q.aspect, 2.5, 1e-14);
    EXPECT_NEAR(quality(one(Cell::quad4, 2, {{0, 0, 0}, v, u + v, u}), {0, 0}).jacobian, -std::sin(a), 1e-14);
    Mesh space = one(Cell::quad4, 3, {{0, 0, 0}, {0, u.x(), 0}, {0, u.x() + v.x(), v.y()}, {0, v.x(), v.y()}});  // upright in space
    EXPECT_NEAR(quality(space, {0, 0}).jacobian, std::sin(a), 1e-14);
  }
}

/// Right-angled cells: triangle sin 90 over sin 60; the corner of a cube as tetrahedron: the three edges at the least corner span 45
/// degrees.
TEST(Quality, RightAngledSimplices) {
  EXPECT_NEAR(quality(one(Cell::tri3, 2, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), {0, 0}).jacobian, std::sin(M_PI / 4) / (root_3 / 2), 1e-14);
  EXPECT_NEAR(quality(one(Cell::tet4, 3, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), {0, 0}).jacobian, 0.5 * std::sqrt(2.0), 1e-14);
}

/// A dented quadrilateral has a negative value at the dent: corner (0.2, 0.2) sees (0, 1) and (1, 0).
TEST(Quality, DentedQuadrilateral) {
  const Vec3 dent{0.2, 0.2, 0}, a{1, 0, 0}, b{0, 1, 0};
  const double wanted = -((b - dent).x() * (a - dent).y() - (b - dent).y() * (a - dent).x()) / ((a - dent).norm() * (b - dent).norm());
  const double corner = quality(one(Cell::quad4, 2, {{0, 0, 0}, a, dent, b}), {0, 0}).jacobian;
  EXPECT_NEAR(corner, -std::abs(wanted), 1e-14);
  EXPECT_LT(corner, 0);
}

/// The middle node of an edge at its quarter point makes the edge's speed there zero: the well-known singular corner. Beyond it, inverted.
TEST(Quality, CurvedEdges) {
  std::vector<Vec3> nodes{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}, {0.5, 0.5, 0}, {0, 0.5, 0}};
  nodes[3].x() = 0.2;
  EXPECT_LT(quality(one(Cell::tri6, 2, nodes), {0, 0}).jacobian, -0.1);
  nodes[3] = {0.5, -0.1, 0};                                                   // parabola with slope -0.4 at the ends
  const double at_0 = 1 / std::sqrt(1.16);                                     // (1, -0.4) and (0, 1)
  const double at_1 = (-1 * 0.4 * -1 + 1) / std::sqrt(1.16) / std::sqrt(2.0);  // tangents (-1, -0.4) and (-1, 1): cross -1 - 0.4
  const double at_2 = 1 / std::sqrt(2.0);
  EXPECT_NEAR(quality(one(Cell::tri6, 2, nodes), {0, 0}).jacobian, std::min({at_0, at_1, at_2}) / (root_3 / 2), 1e-14);
  nodes[3] = {0.5, 0.2, 0};  // slope 0.8 at the ends: nearer to the long edge
  EXPECT_NEAR(quality(one(Cell::tri6, 2, nodes), {0, 0}).jacobian, (1 - 0.8) / std::sqrt(1.64) / std::sqrt(2.0) / (root_3 / 2), 1e-14);
}

TEST(Quality, GroupsAndFrequency) {
  Mesh mesh = rectangle({0, 1, 3, 3.5}, {0, 1});
  auto groups = quality_by_group(mesh);
  ASSERT_EQ(groups.size(), 5u);
  const auto named = [&](const std::string& name) {
    return *std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.name == name; });
  };
  GroupQuality volume = named("volume");
  EXPECT_EQ(volume.cells, 3);
  EXPECT_EQ(volume.shortest, 0.5);
  EXPECT_EQ(volume.longest, 2);
  EXPECT_EQ(volume.aspect, 2);
  EXPECT_EQ(volume.spacing, 2);
  EXPECT_EQ(volume.most_slender.index, 1);
  EXPECT_EQ(named("top").longest, 2);
  EXPECT_DOUBLE_EQ(highest_frequency(volume, 200, 10), 10);  // Hz: a wave of 20 m has ten nodes at 2 m
  mesh.nodes[2].y() = 0.5;                                   // third node of the bottom: the cell between 1 m and 3 m and its neighbour
  groups = quality_by_group(mesh);
  EXPECT_EQ(named("volume").most_distorted.index, 2);
  EXPECT_NEAR(named("volume").jacobian, 1 / std::sqrt(2.0), 1e-14);  // 45 degrees at (3.5, 0)
  mesh = rectangle({0, 1, 3, 3.5}, {0, 1}, Cell::quad8);
  groups = quality_by_group(mesh);
  EXPECT_DOUBLE_EQ(highest_frequency(named("volume"), 200, 10), 20);
}

TEST(Pieces, LooseParts) {
  Mesh mesh = rectangle({0, 1, 2}, {0, 1});  // nodes 0 1 2 / 3 4 5
  EXPECT_EQ(connected_pieces(mesh).count(), 1);
  mesh.nodes.insert(mesh.nodes.begin(), Vec3(9, 9, 0));  // used by nothing
  for (CellBlock& block : mesh.blocks)
    for (int& node : block.nodes) ++node;
  for (const double x : {5.0, 6.0}) mesh.nodes.emplace_back(x, 0, 0);
  auto& lines = mesh.block(Cell::line2);
  lines.nodes.insert(lines.nodes.end(), {8, 7});
  const Pieces pieces = connected_pieces(mesh);
  ASSERT_EQ(pieces.count(), 2);
  EXPECT_EQ(pieces.nodes[0], (std::vector<int>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(pieces.nodes[1], (std::vector<int>{7, 8}));
  EXPECT_EQ(pieces.unused, (std::vector<int>{0}));
}

}  // namespace
}  // namespace uplift::quality_test
