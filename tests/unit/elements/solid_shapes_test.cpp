#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cell_shapes.h"

namespace uplift::solid_shapes_test {
namespace {

Vec3 node_of(Cell cell, int a) {
  const auto& x = cell_nodes(cell)[static_cast<std::size_t>(a)];
  return {x[0], x[1], x[2]};
}

/// A point inside the reference cell: a random mean of its corners.
Vec3 inner_point(Cell cell, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  Vec3 sum = Vec3::Zero();
  double weights = 0;
  for (int c = 0; c < info(cell).corners; ++c) {
    const double w = uniform(random);
    sum += w * node_of(cell, c);
    weights += w;
  }
  return sum / weights;
}

bool is_triangular(Cell cell) {
  const Cell corners = info(cell).linear;
  return corners == Cell::tri3 || corners == Cell::tet4;
}

/// Integral of x^p over [-1, 1].
double line_moment(int p) {
  return p % 2 ? 0 : 2.0 / (p + 1);
}

/// Integral of r^p s^q t^m over the triangle or tet of dimension d: p! q! m! / (p + q + m + d)!.
double simplex_moment(int p, int q, int m, int dimension) {
  return std::tgamma(p + 1) * std::tgamma(q + 1) * std::tgamma(m + 1) / std::tgamma(p + q + m + dimension + 1);
}

double moment(Cell cell, int p, int q, int m) {
  switch (info(cell).linear) {
    case Cell::tri3:
      return simplex_moment(p, q, 0, 2);
    case Cell::tet4:
      return simplex_moment(p, q, m, 3);
    case Cell::wedge6:
      return simplex_moment(p, q, 0, 2) * line_moment(m);
    default: {
      const int d = info(cell).dimension;
      return (d > 0 ? line_moment(p) : 1) * (d > 1 ? line_moment(q) : 1) * (d > 2 ? line_moment(m) : 1);
    }
  }
}

double integral(const CellRule& rule, int p, int q, int m) {
  double sum = 0;
  for (std::size_t i = 0; i < rule.point.size(); ++i)
    sum += rule.weight[i] * std::pow(rule.point[i].x(), p) * std::pow(rule.point[i].y(), q) * std::pow(rule.point[i].z(), m);
  return sum;
}

TEST(SolidShapes, OneAtTheirOwnNodeZeroAtTheOthers) {
  for (const CellInfo& cell : all_cells()) {
    ASSERT_EQ(static_cast<int>(cell_nodes(cell.cell).size()), cell.nodes) << cell.name;
    for (int b = 0; b < cell.nodes; ++b) {
      const CellShape shape = cell_shape(cell.cell, node_of(cell.cell, b));
      for (int a = 0; a < cell.nodes; ++a) EXPECT_NEAR(shape.value[static_cast<std::size_t>(a)], a == b, 1e-15) << cell.name;
    }
  }
}

TEST(SolidShapes, SumToOneAndReproduceTheirPolynomials) {
  // every cell reproduces 1, r, s, t; those of second order all monomials of total degree 2 too
  std::mt19937 random(1);
  for (const CellInfo& cell : all_cells()) {
    const int degree = cell.nodes == cell.corners ? 1 : 2;
    for (int trial = 0; trial < 20; ++trial) {
      const Vec3 x = inner_point(cell.cell, random);
      const CellShape shape = cell_shape(cell.cell, x);
      for (int p = 0; p <= degree; ++p)
        for (int q = 0; p + q <= degree && (q == 0 || cell.dimension > 1); ++q)
          for (int m = 0; p + q + m <= degree && (m == 0 || cell.dimension > 2); ++m) {
            if (cell.dimension == 0 && p > 0) continue;
            double sum = 0;
            for (int a = 0; a < cell.nodes; ++a) {
              const Vec3 n = node_of(cell.cell, a);
              sum += shape.value[static_cast<std::size_t>(a)] * std::pow(n.x(), p) * std::pow(n.y(), q) * std::pow(n.z(), m);
            }
            EXPECT_NEAR(sum, std::pow(x.x(), p) * std::pow(x.y(), q) * std::pow(x.z(), m), 1e-14) << cell.name;
          }
    }
  }
}

TEST(SolidShapes, SlopesAreTheDerivatives) {
  // central differences; all functions are at most cubic along a direction, so the error is h^2 f'''/6
  std::mt19937 random(2);
  const double h = 1e-5;
  for (const CellInfo& cell : all_cells())
    for (int trial = 0; trial < 10; ++trial) {
      const Vec3 x = inner_point(cell.cell, random);
      const CellShape shape = cell_shape(cell.cell, x);
      for (int k = 0; k < cell.dimension; ++k) {
        const CellShape up = cell_shape(cell.cell, x + h * Vec3::Unit(k)), down = cell_shape(cell.cell, x - h * Vec3::Unit(k));
        for (std::size_t a = 0; a < static_cast<std::size_t>(cell.nodes); ++a)
          EXPECT_NEAR(shape.slope[a][static_cast<std::size_t>(k)], (up.value[a] - down.value[a]) / (2 * h), 1e-9) << cell.name;
      }
    }
}

TEST(SolidShapes, OnASideTheyAreThoseOfTheSide) {
  // conformity: two cells with a common side agree on it, whatever their other nodes do
  std::mt19937 random(3);
  for (const CellInfo& cell : all_cells()) {
    std::size_t first = 0;
    for (const Cell side : cell.sides) {
      const auto nodes = cell.side_nodes.subspan(first, static_cast<std::size_t>(info(side).nodes));
      first += nodes.size();
      for (int trial = 0; trial < 5; ++trial) {
        const CellShape on_side = cell_shape(side, inner_point(side, random));
        std::vector<Vec3> positions;
        for (const int a : nodes) positions.push_back(node_of(cell.cell, a));
        const CellShape in_cell = cell_shape(cell.cell, cell_position(on_side, positions));
        std::vector<double> expected(static_cast<std::size_t>(cell.nodes), 0.0);
        for (std::size_t i = 0; i < nodes.size(); ++i) expected[static_cast<std::size_t>(nodes[i])] = on_side.value[i];
        for (std::size_t a = 0; a < expected.size(); ++a) EXPECT_NEAR(in_cell.value[a], expected[a], 1e-14) << cell.name;
      }
    }
  }
}

TEST(SolidShapes, AreaVectorsOfTheSidesPointOutAndClose) {
  for (const CellInfo& cell : all_cells()) {
    if (cell.dimension < 2) continue;
    std::size_t first = 0;
    Vec3 sum = Vec3::Zero();
    for (const Cell side : cell.sides) {
      std::vector<Vec3> positions;
      for (int i = 0; i < info(side).nodes; ++i) positions.push_back(node_of(cell.cell, cell.side_nodes[first++]));
      const CellRule rule = cell_rule(side, 2);
      for (std::size_t i = 0; i < rule.point.size(); ++i) {
        const CellShape shape = cell_shape(side, rule.point[i]);
        const Vec3 area = cell_area_vector(shape, positions, side);
        EXPECT_GT(area.dot(cell_position(shape, positions) - cell_centre(cell.cell)), 0) << cell.name;
        sum += rule.weight[i] * area;
      }
    }
    EXPECT_LE(sum.norm(), 1e-14) << cell.name;
  }
}

TEST(SolidQuadrature, ExactForItsDegree) {
  for (const CellInfo& cell : all_cells())
    for (int degree = 0; degree <= 9; ++degree) {
      const CellRule rule = cell_rule(cell.cell, degree);
      const double round_off = 1e-14 * std::max(1.0, moment(cell.cell, 0, 0, 0));  // of sums of the cell's size
      for (const double w : rule.weight) EXPECT_GT(w, 0) << cell.name;
      for (int p = 0; p <= degree; ++p)
        for (int q = 0; q <= degree; ++q)
          for (int m = 0; m <= degree; ++m) {
            if ((p > 0 && cell.dimension < 1) || (q > 0 && cell.dimension < 2) || (m > 0 && cell.dimension < 3)) continue;
            if (is_triangular(cell.cell) && p + q + m > degree) continue;
            if (cell.linear == Cell::wedge6 && p + q > degree) continue;
            EXPECT_NEAR(integral(rule, p, q, m), moment(cell.cell, p, q, m), round_off)
                << cell.name << " " << p << q << m << " of " << degree;
          }
    }
}

TEST(SolidQuadrature, PointsLieInside) {
  for (const CellInfo& cell : all_cells())
    for (int degree = 0; degree <= 9; ++degree)
      for (const Vec3& x : cell_rule(cell.cell, degree).point) {
        // the linear shape functions of an inner point are positive
        const CellShape shape = cell_shape(cell.linear, x);
        for (int a = 0; a < shape.nodes; ++a) EXPECT_GT(shape.value[static_cast<std::size_t>(a)], 0) << cell.name;
      }
}

TEST(SolidQuadrature, NodalRulesIntegrateTheShapeFunctionsExactly) {
  // sum of w N_a = integral of N_a (by a Gauss rule of high degree): a uniform traction gives the consistent nodal forces
  for (const CellInfo& cell : all_cells()) {
    if (cell.dimension > 2) continue;
    const CellRule nodal = nodal_rule(cell.cell), exact = cell_rule(cell.cell, 6);
    std::vector<double> sum(static_cast<std::size_t>(cell.nodes), 0.0);
    for (std::size_t i = 0; i < nodal.point.size(); ++i) {
      EXPECT_GT(nodal.weight[i], 0) << cell.name;
      if (i < sum.size()) EXPECT_EQ(nodal.point[i], node_of(cell.cell, static_cast<int>(i))) << cell.name;
      const CellShape shape = cell_shape(cell.cell, nodal.point[i]);
      for (std::size_t a = 0; a < sum.size(); ++a) sum[a] += nodal.weight[i] * shape.value[a];
    }
    for (std::size_t i = 0; i < exact.point.size(); ++i) {
      const CellShape shape = cell_shape(cell.cell, exact.point[i]);
      for (std::size_t a = 0; a < sum.size(); ++a) sum[a] -= exact.weight[i] * shape.value[a];
    }
    for (const double rest : sum) EXPECT_NEAR(rest, 0, 1e-14) << cell.name;
  }
}

TEST(SolidQuadrature, NodalRulesHaveTheirDegree) {
  struct Expected {
    Cell cell;
    int degree;
  };
  for (const auto& [cell, degree] : {Expected{Cell::line2, 1}, Expected{Cell::line3, 3}, Expected{Cell::tri3, 1}, Expected{Cell::tri6, 3},
                                     Expected{Cell::quad4, 1}, Expected{Cell::quad8, 3}, Expected{Cell::quad9, 3}})
    for (int p = 0; p <= degree; ++p)
      for (int q = 0; q <= (info(cell).dimension > 1 ? degree : 0); ++q)
        if (!is_triangular(cell) || p + q <= degree)
          EXPECT_NEAR(integral(nodal_rule(cell), p, q, 0), moment(cell, p, q, 0), 1e-15) << info(cell).name << p << q;
}

}  // namespace
}  // namespace uplift::solid_shapes_test
