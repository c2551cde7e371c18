#include "uplift/mesh/cell_quadrature.h"

#include <array>
#include <cassert>
#include <cmath>

#include "uplift/math/quadrature.h"
#include "uplift/mesh/cell_shapes.h"

namespace uplift {

namespace {

void add(CellRule& rule, const Vec3& point, double weight) {
  rule.point.push_back(point);
  rule.weight.push_back(weight);
}

/// The three points (a, a), (1 - 2a, a), (a, 1 - 2a).
void add_orbit(CellRule& rule, double a, double weight) {
  add(rule, {a, a, 0}, weight);
  add(rule, {1 - 2 * a, a, 0}, weight);
  add(rule, {a, 1 - 2 * a, 0}, weight);
}

/// The four points of a tet with three equal barycentric coordinates a.
void add_tet_orbit(CellRule& rule, double a, double weight) {
  const double b = 1 - 3 * a;
  add(rule, {a, a, a}, weight);
  add(rule, {b, a, a}, weight);
  add(rule, {a, b, a}, weight);
  add(rule, {a, a, b}, weight);
}

Quadrature gauss(int degree) {
  return gauss_legendre(degree / 2 + 1);
}

/// Tensor product of a rule of the line over the cell's dimension; the first direction runs fastest.
CellRule product(const Quadrature& line, int dimension) {
  CellRule rule;
  const auto n = line.point.size();
  const Index n2 = dimension > 1 ? n : 1, n3 = dimension > 2 ? n : 1;
  for (Index k = 0; k < n3; ++k)
    for (Index j = 0; j < n2; ++j)
      for (Index i = 0; i < n; ++i)
        add(rule, {line.point[i], dimension > 1 ? line.point[j] : 0, dimension > 2 ? line.point[k] : 0},
            line.weight[i] * (dimension > 1 ? line.weight[j] : 1) * (dimension > 2 ? line.weight[k] : 1));
  return rule;
}

/// The unit square, or cube, collapsed: s = y (1 - r), t = z (1 - r - s) = z (1 - r) (1 - y).
CellRule collapsed(int degree, int dimension) {
  const Quadrature line = gauss(degree + dimension - 1);
  CellRule rule;
  const CellRule square = product(line, dimension);
  for (std::size_t i = 0; i < square.point.size(); ++i) {
    const Vec3 p = (square.point[i] + Vec3::Ones()) / 2;
    const double r = p[0], s = p[1] * (1 - r), rest = 1 - r - s;
    if (dimension == 2)
      add(rule, {r, s, 0}, square.weight[i] / 4 * (1 - r));
    else
      add(rule, {r, s, p[2] * rest}, square.weight[i] / 8 * (1 - r) * rest);
  }
  return rule;
}

CellRule triangle_rule(int degree) {
  CellRule rule;
  if (degree <= 1) {
    add(rule, {1.0 / 3, 1.0 / 3, 0}, 0.5);
  } else if (degree == 2) {
    add_orbit(rule, 1.0 / 6, 1.0 / 6);
  } else if (degree <= 4) {
    const double root = std::sqrt(38 - 44 * std::sqrt(0.4)), other = std::sqrt(213125 - 53320 * std::sqrt(10.0));
    add_orbit(rule, (8 - std::sqrt(10.0) + root) / 18, (620 + other) / 7440);
    add_orbit(rule, (8 - std::sqrt(10.0) - root) / 18, (620 - other) / 7440);
  } else if (degree == 5) {
    const double root = std::sqrt(15.0);
    add(rule, {1.0 / 3, 1.0 / 3, 0}, 9.0 / 80);
    add_orbit(rule, (6 - root) / 21, (155 - root) / 2400);
    add_orbit(rule, (6 + root) / 21, (155 + root) / 2400);
  } else {
    rule = collapsed(degree, 2);
  }
  return rule;
}

CellRule tet_rule(int degree) {
  CellRule rule;
  if (degree <= 1) {
    add(rule, {0.25, 0.25, 0.25}, 1.0 / 6);
  } else if (degree == 2) {
    add_tet_orbit(rule, (5 - std::sqrt(5.0)) / 20, 1.0 / 24);
  } else if (degree <= 5) {
    add_tet_orbit(rule, 0.31088591926330060980, 0.11268792571801585080 / 6);
    add_tet_orbit(rule, 0.092735250310891226402, 0.073493043116361949544 / 6);
    const double a = 0.045503704125649649492, b = 0.5 - a, weight = 0.042546020777081466438 / 6;
    for (const Vec3& p : {Vec3(a, a, b), Vec3(a, b, a), Vec3(b, a, a), Vec3(b, b, a), Vec3(b, a, b), Vec3(a, b, b)}) add(rule, p, weight);
  } else if (degree == 6) {
    add_tet_orbit(rule, 0.21460287125915202929, 0.039922750258167492100 / 6);
    add_tet_orbit(rule, 0.040673958534611353116, 0.010077211055320642948 / 6);
    add_tet_orbit(rule, 0.32233789014227551034, 0.055357181543654722095 / 6);
    const double a = 0.063661001875017525299, b = 0.26967233145831580803, c = 1 - 2 * a - b;
    for (const auto& [p, q] : {std::array{b, c}, std::array{c, b}})  // the fourth coordinate is a, q or p
      for (const Vec3& point : {Vec3(p, q, a), Vec3(a, p, q), Vec3(q, a, p), Vec3(a, a, p), Vec3(a, p, a), Vec3(p, a, a)})
        add(rule, point, 27.0 / 560 / 6);
  } else {
    rule = collapsed(degree, 3);
  }
  return rule;
}

CellRule wedge_rule(int degree) {
  CellRule rule;
  const CellRule triangle = triangle_rule(degree);
  const Quadrature line = gauss(degree);
  for (Index k = 0; k < line.point.size(); ++k)
    for (std::size_t i = 0; i < triangle.point.size(); ++i)
      add(rule, {triangle.point[i].x(), triangle.point[i].y(), line.point[k]}, triangle.weight[i] * line.weight[k]);
  return rule;
}

}  // namespace

CellRule cell_rule(Cell cell, int degree) {
  assert(degree >= 0);
  const Cell corners = info(cell).linear;
  switch (corners) {
    case Cell::point:
      return {{Vec3::Zero()}, {1}};
    case Cell::tri3:
      return triangle_rule(degree);
    case Cell::tet4:
      return tet_rule(degree);
    case Cell::wedge6:
      return wedge_rule(degree);
    default:
      return product(gauss(degree), info(cell).dimension);
  }
}

std::array<int, 2> solid_degrees(Cell cell) {
  switch (cell) {
    case Cell::tri3:
    case Cell::tet4:
      return {1, 2};
    case Cell::tri6:
    case Cell::tet10:
      return {2, 4};
    case Cell::wedge6:
      return {2, 2};
    case Cell::quad4:
    case Cell::hex8:
      return {3, 3};
    case Cell::wedge15:
      return {4, 4};
    default:
      return {5, 5};
  }
}

CellRule nodal_rule(Cell cell) {
  assert(info(cell).dimension <= 2);
  CellRule rule;
  for (const auto& x : cell_nodes(cell)) {
    const bool mid_r = x[0] == 0, mid_s = x[1] == 0;
    double weight = 1;  // point, line2, quad4
    if (cell == Cell::line3) weight = mid_r ? 4.0 / 3 : 1.0 / 3;
    if (cell == Cell::quad8 || cell == Cell::quad9) weight = (mid_r ? 4 : 1) * (mid_s ? 4 : 1) / 9.0;
    if (cell == Cell::tri3) weight = 1.0 / 6;
    if (cell == Cell::tri6) weight = rule.point.size() < 3 ? 1.0 / 40 : 1.0 / 15;
    add(rule, {x[0], x[1], x[2]}, weight);
  }
  if (cell == Cell::quad8) add(rule, Vec3::Zero(), 16.0 / 9);
  if (cell == Cell::tri6) add(rule, cell_centre(cell), 9.0 / 40);
  return rule;
}

}  // namespace uplift
