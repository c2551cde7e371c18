#include <gtest/gtest.h>

#include <map>
#include <random>

#include "unit/mesh/mesh_support.h"

namespace uplift::cells_test {
namespace {

using support::area_of;
using support::centre;
using support::side_nodes;

struct Reference {
  double size;  // length, area, volume
  std::vector<Vec3> nodes;
};

/// Parametric coordinates of the nodes of all types, as VTK lists them (GetParametricCoords of each cell).
const Reference& reference(Cell cell) {
  static const std::vector<Vec3> hex{{0, 0, 0},   {1, 0, 0},   {1, 1, 0},   {0, 1, 0},   {0, 0, 1},   {1, 0, 1},   {1, 1, 1},
                                     {0, 1, 1},   {.5, 0, 0},  {1, .5, 0},  {.5, 1, 0},  {0, .5, 0},  {.5, 0, 1},  {1, .5, 1},
                                     {.5, 1, 1},  {0, .5, 1},  {0, 0, .5},  {1, 0, .5},  {1, 1, .5},  {0, 1, .5},  {0, .5, .5},
                                     {1, .5, .5}, {.5, 0, .5}, {.5, 1, .5}, {.5, .5, 0}, {.5, .5, 1}, {.5, .5, .5}};
  static const std::vector<Vec3> wedge{{0, 0, 0},  {1, 0, 0},  {0, 1, 0},   {0, 0, 1},  {1, 0, 1},  {0, 1, 1},  {.5, 0, 0}, {.5, .5, 0},
                                       {0, .5, 0}, {.5, 0, 1}, {.5, .5, 1}, {0, .5, 1}, {0, 0, .5}, {1, 0, .5}, {0, 1, .5}};
  static const std::vector<Vec3> tet{{0, 0, 0},   {1, 0, 0},  {0, 1, 0},  {0, 0, 1},   {.5, 0, 0},
                                     {.5, .5, 0}, {0, .5, 0}, {0, 0, .5}, {.5, 0, .5}, {0, .5, .5}};
  static const std::vector<Vec3> quad{{0, 0, 0},  {1, 0, 0},  {1, 1, 0},  {0, 1, 0},  {.5, 0, 0},
                                      {1, .5, 0}, {.5, 1, 0}, {0, .5, 0}, {.5, .5, 0}};
  static const std::vector<Vec3> tri{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {.5, 0, 0}, {.5, .5, 0}, {0, .5, 0}};
  static const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {.5, 0, 0}};
  const auto head = [](const std::vector<Vec3>& all, int n) { return std::vector<Vec3>(all.begin(), all.begin() + n); };
  static const std::map<Cell, Reference> table{{Cell::point, {0, head(line, 1)}},
                                               {Cell::line2, {1, head(line, 2)}},
                                               {Cell::line3, {1, line}},
                                               {Cell::tri3, {0.5, head(tri, 3)}},
                                               {Cell::tri6, {0.5, tri}},
                                               {Cell::quad4, {1, head(quad, 4)}},
                                               {Cell::quad8, {1, head(quad, 8)}},
                                               {Cell::quad9, {1, quad}},
                                               {Cell::tet4, {1.0 / 6, head(tet, 4)}},
                                               {Cell::tet10, {1.0 / 6, tet}},
                                               {Cell::wedge6, {0.5, head(wedge, 6)}},
                                               {Cell::wedge15, {0.5, wedge}},
                                               {Cell::hex8, {1, head(hex, 8)}},
                                               {Cell::hex20, {1, head(hex, 20)}},
                                               {Cell::hex27, {1, hex}}};
  return table.at(cell);
}

/// One cell, its reference mapped by a random affine map with a positive determinant; `size` [m, m2, m3] is its size then.
Mesh one_cell(Cell cell, unsigned seed, double& size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> entry(-0.4, 0.4);
  const int d = std::max(2, info(cell).dimension);
  double a[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3 shift = Vec3::Zero();
  for (int i = 0; i < d; ++i) {
    shift[i] = 10 * entry(random);
    for (int j = 0; j < d; ++j) a[i][j] += entry(random);
  }
  Mesh mesh;
  mesh.dimension = d;
  for (const Vec3& x : reference(cell).nodes) {
    Vec3 y = shift;
    for (int i = 0; i < 3; ++i) y[i] += a[i][0] * x[0] + a[i][1] * x[1] + a[i][2] * x[2];
    mesh.nodes.push_back(y);
  }
  auto& block = mesh.block(cell);
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) block.nodes.push_back(i);
  const double determinant = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
                             a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
  size = reference(cell).size * determinant;
  return mesh;
}

TEST(Cells, TableIsComplete) {
  ASSERT_EQ(all_cells().size(), static_cast<std::size_t>(num_cell_types));
  // vtkCellType.h
  const std::map<Cell, int> vtk{{Cell::point, 1},   {Cell::line2, 3},    {Cell::line3, 21}, {Cell::tri3, 5},   {Cell::tri6, 22},
                                {Cell::quad4, 9},   {Cell::quad8, 23},   {Cell::quad9, 28}, {Cell::tet4, 10},  {Cell::tet10, 24},
                                {Cell::wedge6, 13}, {Cell::wedge15, 26}, {Cell::hex8, 12},  {Cell::hex20, 25}, {Cell::hex27, 29}};
  for (int i = 0; i < num_cell_types; ++i) {
    const CellInfo& type = all_cells()[i];
    EXPECT_EQ(static_cast<int>(type.cell), i);
    EXPECT_EQ(&info(type.cell), &type);
    EXPECT_EQ(type.vtk, vtk.at(type.cell)) << type.name;
    EXPECT_EQ(type.nodes, static_cast<int>(reference(type.cell).nodes.size())) << type.name;
    EXPECT_TRUE(type.name.ends_with(std::to_string(type.nodes)) || type.cell == Cell::point) << type.name;
    EXPECT_EQ(info(type.linear).nodes, type.corners);
    EXPECT_EQ(info(type.linear).dimension, type.dimension);
    int nodes = 0;
    for (const Cell side : type.sides) nodes += info(side).nodes;
    EXPECT_EQ(static_cast<int>(type.side_nodes.size()), type.dimension == 1 ? 2 : nodes);
    for (const Cell side : type.sides) EXPECT_EQ(info(side).dimension, type.dimension - 1);
  }
}

/// Divergence theorem with straight sides: the areas add up to zero, and the integral of x.n over the sides is the dimension times the
/// size.
TEST(Cells, SidesPointOutAndClose) {
  for (const CellInfo& type : all_cells()) {
    if (type.dimension < 2) continue;
    for (unsigned seed = 1; seed <= 5; ++seed) {
      double size = 0;
      const Mesh mesh = one_cell(type.cell, seed, size);
      Vec3 areas = Vec3::Zero();
      double flux = 0;
      for (int s = 0; s < static_cast<int>(type.sides.size()); ++s) {
        const Cell side = type.sides[s];
        const auto nodes = side_nodes(mesh, {0, 0}, s);
        const Vec3 area = area_of(mesh, side, nodes), middle = centre(mesh, nodes, info(side).corners);
        EXPECT_GT(area.dot(middle - centre(mesh, {0, 0})), 0) << type.name << " side " << s;
        areas += area;
        flux += area.dot(middle);  // a parallelogram or a triangle: the mean of x is the mean of the corners
      }
      EXPECT_LT(areas.norm(), 1e-13) << type.name;
      EXPECT_NEAR(flux, type.dimension * size, 1e-12) << type.name;
      EXPECT_NEAR(signed_size(mesh, {0, 0}), size, 1e-13) << type.name;
    }
  }
}

TEST(Cells, MiddlesOfEdgesAndFacesOfSides) {
  for (const CellInfo& type : all_cells()) {
    if (type.cell == type.linear) continue;
    double size = 0;
    const Mesh mesh = one_cell(type.cell, 3, size);
    const auto middle = [&](int a, int b) -> Vec3 { return (mesh.nodes[a] + mesh.nodes[b]) / 2; };
    for (std::size_t e = 0; e < type.edges.size(); e += 2)
      EXPECT_LT((mesh.nodes[type.corners + e / 2] - middle(type.edges[e], type.edges[e + 1])).norm(), 1e-14)
          << type.name << " edge " << e / 2;
    if (type.dimension == 1) continue;
    for (int s = 0; s < static_cast<int>(type.sides.size()); ++s) {
      const CellInfo& side = info(type.sides[s]);
      const auto nodes = side_nodes(mesh, {0, 0}, s);
      for (std::size_t e = 0; e < side.edges.size(); e += 2)
        EXPECT_LT((mesh.nodes[nodes[side.corners + e / 2]] - middle(nodes[side.edges[e]], nodes[side.edges[e + 1]])).norm(), 1e-14)
            << type.name << " side " << s;
      if (side.cell == Cell::quad9) EXPECT_LT((mesh.nodes[nodes[8]] - centre(mesh, nodes, 4)).norm(), 1e-14) << type.name << " side " << s;
    }
  }
}

TEST(Cells, EveryNodeOfTheHullIsOnASide) {
  const std::map<Cell, int> inside{{Cell::quad9, 1}, {Cell::hex27, 1}, {Cell::line3, 1}};
  for (const CellInfo& type : all_cells()) {
    if (type.dimension == 0) continue;
    std::vector<int> nodes(type.side_nodes.begin(), type.side_nodes.end());
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    EXPECT_EQ(static_cast<int>(nodes.size()), type.nodes - (inside.contains(type.cell) ? 1 : 0)) << type.name;
  }
}

/// A brick with bilinear warped faces: the volume is the integral of the Jacobian, here by 2 x 2 x 2 Gauss points, which is exact for it.
TEST(Cells, VolumeOfAWarpedBrick) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> entry(-0.2, 0.2);
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Vec3& x = reference(Cell::hex8).nodes[i];
    mesh.nodes.push_back(x + Vec3(entry(random), entry(random), entry(random)));
  }
  mesh.block(Cell::hex8).nodes = {0, 1, 2, 3, 4, 5, 6, 7};
  double volume = 0;
  const double g[] = {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)};
  for (const double r : g)
    for (const double s : g)
      for (const double t : g) {
        Vec3 dr = Vec3::Zero(), ds = Vec3::Zero(), dt = Vec3::Zero();
        for (int i = 0; i < 8; ++i) {
          const Vec3& c = reference(Cell::hex8).nodes[i];
          const auto f = [](double corner, double x) { return corner > 0 ? x : 1 - x; };
          const auto slope = [](double corner) { return corner > 0 ? 1.0 : -1.0; };
          dr += mesh.nodes[i] * slope(c[0]) * f(c[1], s) * f(c[2], t);
          ds += mesh.nodes[i] * f(c[0], r) * slope(c[1]) * f(c[2], t);
          dt += mesh.nodes[i] * f(c[0], r) * f(c[1], s) * slope(c[2]);
        }
        volume +=
            (dr[0] * (ds[1] * dt[2] - ds[2] * dt[1]) + dr[1] * (ds[2] * dt[0] - ds[0] * dt[2]) + dr[2] * (ds[0] * dt[1] - ds[1] * dt[0])) /
            8;
      }
  EXPECT_NEAR(signed_size(mesh, {0, 0}), volume, 1e-14);
}

}  // namespace
}  // namespace uplift::cells_test
