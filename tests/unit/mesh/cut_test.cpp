#include "uplift/mesh/cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "simple_meshes.h"
#include "unit/mesh/mesh_support.h"
#include "uplift/mesh/cell_shapes.h"
#include "uplift/mesh/parts.h"
#include "uplift/mesh/quality.h"

// Cut cells against the geometry: volumes and first moments of both sides, nodes and groups.
namespace uplift::cut_test {
namespace {

std::vector<double> lines(int cells) {
  return uniform_lines(0, 1, cells);
}

Mesh unit_mesh(Cell cell, int cells) {
  return info(cell).dimension == 2 ? rectangle(lines(cells), lines(cells), cell) : box(lines(cells), lines(cells), lines(cells), cell);
}

/// Moves the inner nodes by up to a share of the size of a cell.
void shake(Mesh& mesh, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> move(-size, size);
  for (Vec3& x : mesh.nodes) {
    const Vec3 before = x;
    for (int k = 0; k < mesh.dimension; ++k)
      if (before[k] > 1e-9 && before[k] < 1 - 1e-9) x[k] += move(random);
  }
}

struct Content {
  double volume = 0;
  Vec3 moment = Vec3::Zero();
};

/// Of a group: integrated with the rules of its parts and those of its whole cells.
Content content(const Mesh& mesh, const std::string& group) {
  Content sum;
  for (const CellId id : mesh.groups.at(group).cells) {
    const Cell cell = mesh.type(id);
    std::vector<Vec3> x;
    for (const int node : mesh.cell(id)) x.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
    const CellRule rule = mesh.part(id) ? rule_of_part(mesh, id) : cell_rule(cell, 5);
    for (std::size_t p = 0; p < rule.point.size(); ++p) {
      EXPECT_GT(rule.weight[p], 0);
      const CellShape shape = cell_shape(cell, rule.point[p]);
      const Vec3 a = cell_tangent(shape, x, 0), b = cell_tangent(shape, x, 1);
      const double jacobian = mesh.dimension == 2 ? cross(a, b).z() : cross(a, b).dot(cell_tangent(shape, x, 2));
      sum.volume += rule.weight[p] * jacobian;
      sum.moment += rule.weight[p] * jacobian * cell_position(shape, x);
    }
  }
  return sum;
}

double area_of(const std::vector<CutFace>& faces, int dimension) {
  double sum = 0;
  for (const CutFace& face : faces) {
    if (dimension == 2) sum += (face.corners[1] - face.corners[0]).norm();
    for (std::size_t k = 2; dimension == 3 && k < face.corners.size(); ++k)
      sum += cross(face.corners[k - 1] - face.corners[0], face.corners[k] - face.corners[0]).norm() / 2;
  }
  return sum;
}

TEST(Cut, BothSidesFillTheWhole) {
  std::mt19937 random(7);
  std::normal_distribution<double> component;
  std::uniform_real_distribution<double> place(0.2, 0.8);
  for (const Cell cell : {Cell::tri3, Cell::quad4, Cell::tet4, Cell::wedge6, Cell::hex8})
    for (int repeat = 0; repeat < 40; ++repeat) {
      Mesh mesh = unit_mesh(cell, 3);
      if (repeat % 2) shake(mesh, 0.05, random);
      const int d = mesh.dimension;
      Vec3 normal(component(random), component(random), d == 3 ? component(random) : 0);
      normal.normalize();
      const Vec3 point(place(random), place(random), d == 3 ? place(random) : 0);
      const Content whole = content(mesh, "volume");
      const auto faces = cut(mesh, {{{"volume"}, {normal, normal.dot(point)}, {{{}, "above"}}}}, {{}});
      const Content below = content(mesh, "volume"), above = content(mesh, "above");
      EXPECT_NEAR(below.volume + above.volume, 1, 1e-12) << info(cell).name;
      const bool warped = repeat % 2 && (cell == Cell::wedge6 || cell == Cell::hex8);  // faces are then divided into triangles
      EXPECT_NEAR((below.moment + above.moment - whole.moment).norm(), 0, warped ? 1e-4 : 1e-12) << info(cell).name;
      EXPECT_GT(below.volume, 0);
      EXPECT_GT(above.volume, 0);
      // The area of the section is the derivative of the volume below by the level.
      const double step = 1e-5;
      Mesh lower = unit_mesh(cell, 3), upper = lower;
      cut(lower, {{{"volume"}, {normal, normal.dot(point) - step}, {{{}, "above"}}}}, {{}});
      cut(upper, {{{"volume"}, {normal, normal.dot(point) + step}, {{{}, "above"}}}}, {{}});
      const double slope = (content(upper, "volume").volume - content(lower, "volume").volume) / (2 * step);
      EXPECT_NEAR(area_of(faces[0], d), slope, 1e-4) << info(cell).name;
    }
}

/// Integral of r^i s^j t^k over a group of one cell, in the measure of the reference cell.
double power(const Mesh& mesh, const std::string& group, const std::array<int, 3>& exponent) {
  double sum = 0;
  for (const CellId id : mesh.groups.at(group).cells) {
    const CellRule rule = rule_of_part(mesh, id);
    for (std::size_t p = 0; p < rule.point.size(); ++p)
      sum += rule.weight[p] * std::pow(rule.point[p].x(), exponent[0]) * std::pow(rule.point[p].y(), exponent[1]) *
             std::pow(rule.point[p].z(), exponent[2]);
  }
  return sum;
}

TEST(Cut, MassOfACutParallelepipedIsExact) {
  // products of two trilinear shape functions: both sides together are the integrals over the cube [-1, 1]^3
  std::mt19937 random(11);
  std::normal_distribution<double> component;
  for (int repeat = 0; repeat < 30; ++repeat) {
    Mesh mesh = unit_mesh(Cell::hex8, 1);
    for (Vec3& x : mesh.nodes) x = Vec3(2 * x[0] + 0.3 * x[1], x[1] + 0.2 * x[2], 0.7 * x[2] - 0.1 * x[0]);
    Vec3 middle = Vec3::Zero();
    for (const Vec3& x : mesh.nodes) middle += x / 8;
    const Vec3 normal = Vec3(component(random), component(random), component(random)).normalized();
    cut(mesh, {{{"volume"}, {normal, normal.dot(middle) + 0.1 * component(random)}, {{{}, "above"}}}}, {{}});
    for (const int i : {0, 1, 2})
      for (const int j : {0, 1, 2})
        for (const int k : {0, 1, 2}) {
          const auto along = [](int n) { return n % 2 ? 0.0 : 2.0 / (n + 1); };
          const std::array<int, 3> exponent{i, j, k};
          EXPECT_NEAR(power(mesh, "volume", exponent) + power(mesh, "above", exponent), along(i) * along(j) * along(k), 1e-13)
              << i << j << k;
        }
  }
}

TEST(Cut, BoxOfAnOutlineIsExact) {
  // The unit square or cube, level cut at 0.37, above it x from 0.21 to 0.83 and height 0.4: volumes, centres and areas are those of boxes.
  for (const Cell cell : {Cell::tri3, Cell::quad4, Cell::tet4, Cell::wedge6, Cell::hex8}) {
    Mesh mesh = unit_mesh(cell, 4);
    const int d = mesh.dimension;
    const Vec3 up = d == 2 ? Vec3::UnitY() : Vec3::UnitZ();
    CutPlane plane{{"volume"}, {up, 0.37}, {{{}, "raft"}}};
    plane.outlines.front().within = {{-Vec3::UnitX(), -0.21}, {Vec3::UnitX(), 0.83}, {up, 0.77}};
    const auto faces = cut(mesh, {plane}, {{}});
    const Content below = content(mesh, "volume"), above = content(mesh, "raft");
    EXPECT_NEAR(below.volume, 0.37, 1e-13) << info(cell).name;
    EXPECT_NEAR(above.volume, 0.62 * 0.4, 1e-13) << info(cell).name;
    EXPECT_NEAR(above.moment.x() / above.volume, 0.52, 1e-12);
    EXPECT_NEAR(above.moment[d - 1] / above.volume, 0.57, 1e-12);
    EXPECT_NEAR(area_of(faces[0], d), 0.62, 1e-13) << info(cell).name;
    if (cell == Cell::quad4 || cell == Cell::hex8)
      for (const CutFace& face : faces[0]) EXPECT_TRUE(face.level);
    EXPECT_TRUE(std::ranges::any_of(faces[0], &CutFace::clipped));
  }
}

TEST(Cut, ThroughNodesOpensTheMeshThere) {
  for (const Cell cell : {Cell::tri3, Cell::quad4, Cell::tet4, Cell::wedge6, Cell::hex8}) {
    Mesh mesh = unit_mesh(cell, 4);
    const int d = mesh.dimension;
    const std::size_t nodes = mesh.nodes.size(), layer = d == 2 ? 5 : 25;
    const int cells = mesh.cells();
    const auto faces = cut(mesh, {{{"volume"}, {d == 2 ? Vec3::UnitY() : Vec3::UnitZ(), 0.5}, {{{}, "above"}}}}, {{}});
    EXPECT_TRUE(mesh.parts.empty());
    EXPECT_TRUE(mesh.followers.empty());
    EXPECT_EQ(mesh.nodes.size(), nodes + layer) << info(cell).name;
    EXPECT_EQ(mesh.cells(), cells);
    EXPECT_NEAR(area_of(faces[0], d), 1, 1e-13);
    EXPECT_EQ(connected_pieces(mesh).count(), 2);
  }
}

TEST(Cut, NodesSharesAndGroups) {
  // 2 x 2 squares, cut at 0.3: doubled are three nodes at y = 0 for the upper part and three at 0.5 for the lower one.
  Mesh mesh = rectangle(lines(2), lines(2));
  const auto faces = cut(mesh, {{{"volume"}, {Vec3::UnitY(), 0.3}, {{{}, "above"}}}}, {{}});
  EXPECT_EQ(mesh.nodes.size() - mesh.followers.size(), 9u + 6u);
  EXPECT_EQ(mesh.groups.at("volume").cells.size(), 2u);
  EXPECT_EQ(mesh.groups.at("above").cells.size(), 4u);
  EXPECT_EQ(mesh.groups.at("left").cells.size(), 3u);  // the lower of two edges in two parts
  EXPECT_EQ(faces[0].size(), 2u);
  EXPECT_EQ(mesh.followers.size(), 6u);  // three places, each on both sides
  EXPECT_EQ(connected_pieces(mesh).count(), 2);
  const Mesh drawn = drawn_mesh(mesh);
  double area = 0;
  for (const char* group : {"volume", "above"})
    for (const CellId id : drawn.groups.at(group).cells) {
      EXPECT_GT(signed_size(drawn, id), 0);
      area += signed_size(drawn, id);
    }
  EXPECT_NEAR(area, 1, 1e-14);
}

TEST(Cut, WhatIsOutsideOfTheOutlineIsRemoved) {
  Mesh mesh = rectangle(lines(8), lines(8));
  CutPlane plane{{"volume"}, {Vec3::UnitY(), 0.3}, {{{}, "raft"}}};
  plane.outlines.front().within = {{-Vec3::UnitX(), -0.25}, {Vec3::UnitX(), 0.75}};
  cut(mesh, {plane}, {{}});
  check_mesh(mesh, {});
  for (const CellId id : mesh.groups.at("raft").cells) {
    EXPECT_GT(support::centre(mesh, id).x(), 0.25);
    EXPECT_LT(support::centre(mesh, id).x(), 0.75);
  }
  EXPECT_NEAR(content(mesh, "volume").volume, 0.3, 1e-14);
  EXPECT_NEAR(content(mesh, "raft").volume, 0.5 * 0.7, 1e-14);
  std::vector<bool> used(mesh.nodes.size(), false);
  for (const CellBlock& block : mesh.blocks)
    for (const int node : block.nodes) used[static_cast<std::size_t>(node)] = true;
  for (const Follower& follower : mesh.followers) used[static_cast<std::size_t>(follower.node)] = true;
  EXPECT_EQ(std::ranges::count(used, false), 0);
}

TEST(Cut, SliversAreRightOrSnapped) {
  for (const double above : {1e-12, 1e-10, 1e-8, 1e-6, 1e-4})
    for (const Cell cell : {Cell::tri3, Cell::quad4, Cell::tet4, Cell::hex8}) {
      Mesh mesh = unit_mesh(cell, 2);
      const int d = mesh.dimension;
      const double level = 0.5 + above;
      cut(mesh, {{{"volume"}, {d == 2 ? Vec3::UnitY() : Vec3::UnitZ(), level}, {{{}, "above"}}}}, {{}});
      EXPECT_NEAR(content(mesh, "volume").volume, level, 1e-8);
      EXPECT_NEAR(content(mesh, "volume").volume + content(mesh, "above").volume, 1, 1e-13);
      EXPECT_EQ(mesh.parts.empty(), above < 1e-9);
    }
}

TEST(Cut, TwoPlanesAtDifferentPlaces) {
  for (const Cell cell : {Cell::tri3, Cell::quad4, Cell::tet4, Cell::wedge6, Cell::hex8})
    for (const double second : {0.7, 0.45}) {  // in rows of 1/8: apart from the first, and next to it
      const int d = info(cell).dimension;
      Mesh mesh = d == 2 ? unit_mesh(cell, 8) : box(lines(2), lines(2), lines(8), cell);
      const Vec3 up = d == 2 ? Vec3::UnitY() : Vec3::UnitZ();
      const auto faces = cut(mesh, {{{"volume"}, {up, 0.3}, {{{}, "middle"}}}, {{"middle"}, {up, second}, {{{}, "upper"}}}}, {{}, {}});
      EXPECT_NEAR(content(mesh, "volume").volume, 0.3, 1e-13);
      EXPECT_NEAR(content(mesh, "middle").volume, second - 0.3, 1e-13);
      EXPECT_NEAR(content(mesh, "upper").volume, 1 - second, 1e-13);
      EXPECT_EQ(connected_pieces(mesh).count(), 3) << info(cell).name << second;
      for (const std::vector<CutFace>& of_plane : faces) {
        EXPECT_NEAR(area_of(of_plane, d), 1, 1e-13);
        for (const CutFace& face : of_plane) {
          EXPECT_TRUE(mesh.part(face.lower));
          EXPECT_TRUE(mesh.part(face.upper));
        }
      }
    }
}

TEST(Cut, TwoOutlinesOnOnePlane) {
  for (const Cell cell : {Cell::tri3, Cell::quad4, Cell::tet4, Cell::hex8}) {
    Mesh mesh = unit_mesh(cell, 8);
    const int d = mesh.dimension;
    const Vec3 up = d == 2 ? Vec3::UnitY() : Vec3::UnitZ();
    const auto between = [&](double from, double to) { return std::vector<HalfSpace>{{-Vec3::UnitX(), -from}, {Vec3::UnitX(), to}}; };
    CutPlane plane{{"volume"}, {up, 0.3}, {{between(0.1, 0.32), "first"}, {between(0.6, 0.95), "second"}}};
    plane.outlines[1].within.push_back({up, 0.8});
    const auto faces = cut(mesh, {plane}, {{}});
    ASSERT_EQ(faces.size(), 1U);
    std::array<std::vector<CutFace>, 2> of;
    for (const CutFace& face : faces[0]) of[static_cast<std::size_t>(face.outline)].push_back(face);
    EXPECT_NEAR(area_of(of[0], d), 0.22, 1e-13) << info(cell).name;
    EXPECT_NEAR(area_of(of[1], d), 0.35, 1e-13) << info(cell).name;
    EXPECT_NEAR(content(mesh, "volume").volume, 0.3, 1e-13) << info(cell).name;
    EXPECT_NEAR(content(mesh, "first").volume, 0.22 * 0.7, 1e-13) << info(cell).name;
    EXPECT_NEAR(content(mesh, "second").volume, 0.35 * 0.5, 1e-13) << info(cell).name;
  }
}

/// Ground whose surface is at 0.3 up to x = 0.5 and at `high` beyond, each with a structure on it; that of the lower one reaches to `wall`.
std::vector<CutPlane> terraces(const Vec3& up, double high, double wall) {
  const HalfSpace left{Vec3::UnitX(), 0.5}, right{-Vec3::UnitX(), -0.5};
  const auto between = [&](double from, double to) { return std::vector<HalfSpace>{{-Vec3::UnitX(), -from}, {Vec3::UnitX(), to}}; };
  return {{.through = {"volume"}, .below = {up, 0.3}, .outlines = {{between(0.07, wall), "low"}}, .extent = {left}},
          {.through = {"volume"}, .below = {up, high}, .outlines = {{between(0.61, 0.93), "high"}}, .extent = {right}}};
}

TEST(Cut, GroundWithTwoLevels) {
  // 0.30, 0.31 lie in one row of cells of 1/8, 0.30 and 0.45 in neighbouring ones; 0.25 and 0.5 are levels of nodes
  for (const Cell cell : {Cell::tri3, Cell::quad4, Cell::tet4, Cell::wedge6, Cell::hex8})
    for (const double high : {0.31, 0.45, 0.5, 0.71})
      for (const double wall : {0.32, 0.46, 0.5}) {  // a cell away, less than one, at the wall
        const int d = info(cell).dimension;
        Mesh mesh = d == 2 ? unit_mesh(cell, 8) : box(lines(8), lines(2), lines(8), cell);
        const auto faces = cut(mesh, terraces(d == 2 ? Vec3::UnitY() : Vec3::UnitZ(), high, wall), {{}, {}});
        check_mesh(mesh, {});
        EXPECT_NEAR(content(mesh, "volume").volume, 0.15 + high / 2, 1e-12) << info(cell).name << high << wall;
        EXPECT_NEAR(content(mesh, "low").volume, (wall - 0.07) * 0.7, 1e-12) << info(cell).name << high << wall;
        EXPECT_NEAR(content(mesh, "high").volume, 0.32 * (1 - high), 1e-12) << info(cell).name << high << wall;
        EXPECT_NEAR(area_of(faces[0], d), wall - 0.07, 1e-12);
        EXPECT_NEAR(area_of(faces[1], d), 0.32, 1e-12);
        EXPECT_EQ(connected_pieces(mesh).count(), 3) << info(cell).name << high << wall;  // the ground and both structures
      }
}

TEST(Cut, FacesOfAWallStayWithTheGround) {
  // 8 x 8 squares; a group of the faces at x = 0.5 from 0.25 up
  Mesh mesh = rectangle(lines(8), lines(8));
  Group& wall = mesh.groups["wall"];
  wall.dimension = 1;
  CellBlock& edges = mesh.block(Cell::line2);
  for (int j = 2; j < 8; ++j) {
    wall.cells.push_back({mesh.find_block(Cell::line2), edges.count()});
    edges.nodes.insert(edges.nodes.end(), {j * 9 + 4, (j + 1) * 9 + 4});
  }
  cut(mesh, terraces(Vec3::UnitY(), 0.71, 0.5), {{}, {}});
  double least = 1, most = 0;
  for (const CellId id : mesh.groups.at("wall").cells) {
    EXPECT_GE(Sides(mesh, mesh.groups.at("volume").cells).find(Cell::line2, mesh.cell(id)), 0);
    const CellRule rule = mesh.part(id) ? rule_of_part(mesh, id) : cell_rule(Cell::line2, 5);
    for (const Vec3& point : rule.point) {
      const double y =
          cell_position(cell_shape(Cell::line2, point), std::vector<Vec3>{mesh.nodes[static_cast<std::size_t>(mesh.cell(id)[0])],
                                                                          mesh.nodes[static_cast<std::size_t>(mesh.cell(id)[1])]})
              .y();
      least = std::min(least, y), most = std::max(most, y);
    }
  }
  EXPECT_GT(least, 0.25);
  EXPECT_LT(most, 0.71);
  EXPECT_GT(most, 0.625);
}

TEST(Cut, KeepsTheNamesOfGroupsOfWhichNothingIsLeft) {
  Mesh mesh = rectangle(lines(4), lines(4));
  cut(mesh, {{{"volume"}, {Vec3::UnitY(), 0.3}, {{{{-Vec3::UnitX(), -0.3}, {Vec3::UnitY(), 0.6}}, "raft"}}}}, {{}});
  EXPECT_FALSE(mesh.groups.contains("top"));
  EXPECT_EQ(mesh.emptied, std::vector<std::string>{"top"});
}

std::string refused(Mesh mesh, const std::vector<CutPlane>& planes) {
  const Mesh before = mesh;
  try {
    cut(mesh, planes, std::vector<Where>(planes.size()));
  } catch (const InputError& error) {
    EXPECT_EQ(mesh.nodes.size(), before.nodes.size());
    return error.what();
  }
  return "";
}

TEST(Cut, RefusesWithASentence) {
  const Mesh mesh = rectangle(lines(4), lines(4)), curved = rectangle(lines(4), lines(4), Cell::quad8);
  const auto level = [](double y) { return CutPlane{{"volume"}, {Vec3::UnitY(), y}, {{{}, "above"}}}; };
  EXPECT_NE(refused(mesh, {level(1.5)}).find("from -1.5 m to -0.5 m above it"), std::string::npos) << refused(mesh, {level(1.5)});
  EXPECT_NE(refused(mesh, {level(1 - 1e-8)}).find("a layer of 1e-08 m above it"), std::string::npos) << refused(mesh, {level(1 - 1e-8)});
  EXPECT_NE(refused(mesh, {level(1e-8)}).find("a layer of 1e-08 m below it"), std::string::npos) << refused(mesh, {level(1e-8)});
  EXPECT_NE(refused(curved, {level(0.3)}).find("first degree"), std::string::npos);
  EXPECT_EQ(refused(curved, {level(0.5)}), "");  // along faces
  CutPlane wrong = level(0.3);
  wrong.through = {"volumes"};
  EXPECT_NE(refused(mesh, {wrong}).find("volume"), std::string::npos);
  CutPlane nothing = level(0.3);
  nothing.outlines.front().within = {{Vec3::UnitX(), -1}};
  EXPECT_NE(refused(mesh, {nothing}), "");
  CutPlane near = level(0.3);
  near.outlines = {{{{Vec3::UnitX(), 0.3}}, "one"}, {{{-Vec3::UnitX(), -0.4}}, "two"}};
  EXPECT_NE(refused(mesh, {near}).find("at least a cell apart, found two of them"), std::string::npos) << refused(mesh, {near});
  const std::vector<CutPlane> levels = terraces(Vec3::UnitY(), 0.71, 0.32);
  CutPlane crossed = levels[0], empty = levels[0];
  crossed.extent[0].level = 0.6;
  EXPECT_NE(refused(mesh, {crossed, levels[1]}).find("along faces of cells"), std::string::npos) << refused(mesh, {crossed, levels[1]});
  empty.extent[0].level = -1;
  EXPECT_NE(refused(mesh, {empty}).find("no cells between the limits"), std::string::npos) << refused(mesh, {empty});
  CutPlane within_low = level(0.31);
  within_low.through = {"low"};
  within_low.outlines[0].upper = "top";
  EXPECT_NE(refused(mesh, {levels[0], within_low}).find("same cell"), std::string::npos) << refused(mesh, {levels[0], within_low});
  CutPlane second{{"above"}, {Vec3::UnitY(), 0.31}, {{{}, "upper"}}};
  EXPECT_NE(refused(mesh, {level(0.3), second}).find("same cell"), std::string::npos);
}

}  // namespace
}  // namespace uplift::cut_test
