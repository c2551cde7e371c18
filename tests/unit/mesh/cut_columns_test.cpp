#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "simple_meshes.h"
#include "uplift/mesh/cut.h"
#include "uplift/mesh/parts.h"
#include "uplift/mesh/placed_cell.h"

// Parts of cells with four (in the plane two) edges that a plane crosses from end to end.
namespace uplift::cut_columns_test {
namespace {

Mesh one_cell(int dimension) {
  const std::vector<double> line{0, 1};
  return dimension == 2 ? rectangle(line, line) : box(line, line, line);
}

/// Integral of x^i y^j z^k over 0 <= x, y <= 1 (x from `left` on), 0 <= z <= a + b x + c y, by the binomial theorem.
double below_plane(const std::array<int, 3>& power, double left, double a, double b, double c) {
  const int n = power[2] + 1;
  double sum = 0;
  const auto factorial = [](int m) { return std::tgamma(m + 1); };
  for (int p = 0; p <= n; ++p)
    for (int q = 0; p + q <= n; ++q) {
      const double terms = factorial(n) / (factorial(p) * factorial(q) * factorial(n - p - q));
      const int i = power[0] + p + 1, j = power[1] + q + 1;
      sum += terms * std::pow(b, p) * std::pow(c, q) * std::pow(a, n - p - q) * (1 - std::pow(left, i)) / (i * j);
    }
  return sum / n;
}

/// Integral over a part by its rule; x, y, z from 0 to 1 in the cell, in the order `axis`.
double power_sum(const Mesh& mesh, CellId id, const std::array<int, 3>& power, const std::array<int, 3>& axis) {
  const CellRule rule = rule_of_part(mesh, id);
  double sum = 0;
  for (std::size_t p = 0; p < rule.weight.size(); ++p) {
    EXPECT_GT(rule.weight[p], 0);
    double value = rule.weight[p] / (mesh.dimension == 2 ? 4 : 8);
    for (std::size_t k = 0; k < 3; ++k) value *= std::pow((1 + rule.point[p][axis[k]]) / 2, power[k]);
    sum += value;
  }
  return sum;
}

/// Sheared: the rules are in local coordinates.
Vec3 sheared(const Vec3& x) {
  return {2 * x[0] + 0.3 * x[1], x[1] + 0.2 * x[2], 0.7 * x[2] - 0.1 * x[0]};
}

TEST(CutColumns, ProductsOfShapeFunctionsAreExact) {
  const std::array<std::array<int, 3>, 3> orders{{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}}};
  for (const std::array<int, 3>& axis : orders)
    for (const double left : {0.0, 0.3}) {
      const double a = 0.35, b = 0.25, c = -0.2;  // height a + b x + c y
      Mesh mesh = one_cell(3);
      for (Vec3& x : mesh.nodes) x = sheared(x);
      const auto place = [&](double x, double y, double z) {
        Vec3 local;
        local[axis[0]] = x, local[axis[1]] = y, local[axis[2]] = z;
        return sheared(local);
      };
      const auto plane = [](const Vec3& on, const Vec3& along, const Vec3& beside) {
        const Vec3 normal = cross(along, beside).normalized();
        return HalfSpace{normal, normal.dot(on)};
      };
      const HalfSpace below = plane(place(0, 0, a), place(1, 0, b), place(0, 1, c));
      CutPlane cutting{{"volume"}, below, {{{}, "above"}}};
      if (left > 0) cutting.outlines[0].within = {plane(place(left, 0, 0), place(0, 0, 1), place(0, 1, 0))};
      if (left > 0) EXPECT_LT(cutting.outlines[0].within[0].distance(place(1, 0, 0)), 0);
      cut(mesh, {cutting}, {{}});
      const CellId lower = mesh.groups.at("volume").cells[0], upper = mesh.groups.at("above").cells[0];
      EXPECT_EQ(rule_of_part(mesh, lower).weight.size(), 18U);
      EXPECT_EQ(rule_of_part(mesh, upper).weight.size(), 18U);
      for (const int i : {0, 1, 2})
        for (const int j : {0, 1, 2})
          for (const int k : {0, 1, 2}) {
            const double whole = (1 - std::pow(left, i + 1)) / ((i + 1) * (j + 1) * (k + 1));
            EXPECT_NEAR(power_sum(mesh, lower, {i, j, k}, axis), below_plane({i, j, k}, 0, a, b, c), 1e-15);
            EXPECT_NEAR(power_sum(mesh, upper, {i, j, k}, axis), whole - below_plane({i, j, k}, left, a, b, c), 1e-15);
          }
    }
}

TEST(CutColumns, InThePlaneToo) {
  Mesh mesh = one_cell(2);
  const double a = 0.35, b = 0.4;
  const Vec3 normal = Vec3(-b, 1, 0).normalized();
  cut(mesh, {{{"volume"}, {normal, normal.dot(Vec3(0, a, 0))}, {{{}, "above"}}}}, {{}});
  const CellId lower = mesh.groups.at("volume").cells[0], upper = mesh.groups.at("above").cells[0];
  for (const int i : {0, 1, 2})
    for (const int k : {0, 1, 2}) {
      const double part = below_plane({i, 0, k}, 0, a, b, 0);
      EXPECT_NEAR(power_sum(mesh, lower, {i, 0, k}, {0, 2, 1}), part, 1e-15);
      EXPECT_NEAR(power_sum(mesh, upper, {i, 0, k}, {0, 2, 1}), 1.0 / ((i + 1) * (k + 1)) - part, 1e-15);
    }
}

/// Each part is drawn as one cell that fills it; neighbours share its corners.
TEST(CutColumns, AreDrawnAsOneCell) {
  for (const int dimension : {2, 3})
    for (const bool warped : {false, true}) {
      const std::vector<double> lines{0, 0.25, 0.5, 0.75, 1}, up{0, 1};
      Mesh mesh = dimension == 2 ? rectangle(lines, up) : box(lines, lines, up);
      if (warped)
        for (Vec3& x : mesh.nodes) x[dimension - 1] += 0.1 * std::sin(7 * x[0] + 5 * x[1] * (dimension - 2));
      const Vec3 normal = dimension == 2 ? Vec3(0.2, 1, 0).normalized() : Vec3(0.2, 0.1, 1).normalized();
      const Mesh before = mesh;
      cut(mesh, {{{"volume"}, {normal, 0.6}, {{{}, "above"}}}}, {{}});
      const std::size_t edges = dimension == 2 ? 5 : 25;
      EXPECT_EQ(mesh.followers.size(), 2 * edges);  // on both sides
      for (const Follower& follower : mesh.followers) {
        ASSERT_EQ(follower.of.size(), 2U);
        Vec3 place = Vec3::Zero();
        for (const auto& [node, weight] : follower.of) place += weight * mesh.nodes[static_cast<std::size_t>(node)];
        EXPECT_NEAR((place - mesh.nodes[static_cast<std::size_t>(follower.node)]).norm(), 0, 1e-15);
        EXPECT_NEAR(normal.dot(place), 0.6, 1e-15);
      }
      const Mesh drawn = drawn_mesh(mesh);
      double size = 0, whole = 0;
      for (const char* group : {"volume", "above"}) {
        const std::vector<CellId>& cells = drawn.groups.at(group).cells;
        EXPECT_EQ(cells.size(), dimension == 2 ? 4U : 16U);
        for (const CellId id : cells) {
          EXPECT_EQ(drawn.type(id), dimension == 2 ? Cell::quad4 : Cell::hex8);
          EXPECT_GT(signed_size(drawn, id), 0);
          size += signed_size(drawn, id);
        }
      }
      for (const CellId id : before.groups.at("volume").cells) whole += signed_size(before, id);
      EXPECT_NEAR(size, whole, 1e-14);
    }
}

}  // namespace
}  // namespace uplift::cut_columns_test
