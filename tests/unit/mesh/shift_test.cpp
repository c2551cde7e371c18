#include "uplift/mesh/shift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simple_meshes.h"

// Moving a mesh against a plane: what the mesh describes stays, and no cell turns inside out.
namespace uplift::shift_test {
namespace {

double volume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    if (info(mesh.blocks[b].cell).dimension == mesh.dimension)
      for (int i = 0; i < mesh.blocks[b].count(); ++i) sum += signed_size(mesh, {static_cast<int>(b), i});
  return sum;
}

TEST(ShiftNodes, KeepsTheBodyAndItsCells) {
  const auto x = uniform_lines(0, 3, 6), y = uniform_lines(0, 2, 5);
  for (const Cell cell : {Cell::tri3, Cell::quad4, Cell::tet4, Cell::wedge6, Cell::hex8})
    for (const Vec3& direction : {Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0.6, 0.8, 0)})
      for (const double share : {-0.45, 0.3}) {
        Mesh mesh = info(cell).dimension == 2 ? rectangle(x, y, cell) : box(x, y, y, cell);
        const Mesh before = mesh;
        const CutPlane plane{{"volume"}, {direction, direction.dot(Vec3(1.3, 0.9, 0))}};
        shift_nodes(mesh, plane, share);
        EXPECT_NO_THROW(check_mesh(mesh, {})) << info(cell).name;
        EXPECT_NEAR(volume(mesh), volume(before), 1e-12 * volume(before)) << info(cell).name;
        double most = 0;
        for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
          const Vec3 moved = mesh.nodes[i] - before.nodes[i];
          most = std::max(most, moved.norm());
          EXPECT_LT(cross(moved, direction).norm(), 1e-15);
          EXPECT_GE(share * moved.dot(direction), 0);
          for (int axis = 0; axis < 2; ++axis) {  // sides of the box stay in their planes
            const double end = axis == 0 ? 3 : 2, place = before.nodes[i][axis];
            if (std::abs(place) < 1e-12 || std::abs(place - end) < 1e-12) EXPECT_NEAR(mesh.nodes[i][axis], place, 1e-15);
          }
        }
        EXPECT_GT(most, 0.5 * std::abs(share) * 0.4) << info(cell).name;
      }
}

TEST(ShiftNodes, OtherGroupsBeamsAndNamedNodesStay) {
  const Grid lines{uniform_lines(-1, 1, 4), uniform_lines(0, 10, 10), {}};
  Mesh mesh = grid(
      lines, [](int, int j, int) { return j < 4 ? 0 : 1; }, {"rock", "soil"},
      [](int, Direction direction, int other) -> std::string { return other >= 0 ? "" : std::string(name_of(direction)); });
  int named = -1;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    if ((mesh.nodes[i] - Vec3(0, 5, 0)).norm() < 1e-9) named = static_cast<int>(i);
  ASSERT_GE(named, 0);
  Group point;
  point.nodes = {named};
  mesh.groups["instrument"] = point;
  const Mesh before = mesh;
  const CutPlane plane{{"soil"}, {Vec3::UnitY(), 4.4}};
  shift_nodes(mesh, plane, 0.45, {"left"});
  int moved = 0;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const double way = mesh.nodes[i].y() - before.nodes[i].y(), y = before.nodes[i].y(), x = before.nodes[i].x();
    const bool stays = y < 4 + 1e-9 || y > 4.4 + 3 - 1e-9 || x < -1 + 1e-9 || static_cast<int>(i) == named;
    if (stays)
      EXPECT_EQ(way, 0) << x << " " << y;
    else
      EXPECT_NEAR(way, 0.45 * (1 - std::abs(y - 4.4) / 3), 1e-12) << x << " " << y;
    moved += way != 0;
  }
  EXPECT_EQ(moved, 4 * 3 - 1);
  EXPECT_NO_THROW(check_mesh(mesh, {}));
}

TEST(ShiftNodes, ThinCellsBesideFixedOnesKeepTheirShape) {
  // a row of a twentieth of the height of its neighbours, with another group behind it
  const Grid lines{uniform_lines(-1, 1, 4), {0, 1, 2, 2.05, 3}, {}};
  Mesh mesh = grid(
      lines, [](int, int j, int) { return j < 3 ? 0 : 1; }, {"soil", "rock"},
      [](int, Direction direction, int other) -> std::string { return other >= 0 ? "" : std::string(name_of(direction)); });
  shift_nodes(mesh, {{"soil"}, {Vec3::UnitY(), 1.7}}, 0.45);
  EXPECT_NO_THROW(check_mesh(mesh, {}));
}

}  // namespace
}  // namespace uplift::shift_test
