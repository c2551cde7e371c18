#include "uplift/elements/solid_rules.h"

#include <array>
#include <cassert>

#include "uplift/math/dense.h"
#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cell_shapes.h"

namespace uplift {

namespace {

SolidRule tabulate(Cell cell, const CellRule& rule) {
  SolidRule table{rule.point, rule.weight, {}, {}};
  table.value.assign(rule.point.size() * max_functions, 0.0);
  table.slope.assign(rule.point.size() * 3 * max_functions, 0.0);
  for (std::size_t p = 0; p < rule.point.size(); ++p) {
    const CellShape shape = cell_shape(cell, rule.point[p]);
    for (std::size_t a = 0; a < static_cast<std::size_t>(shape.nodes); ++a) {
      table.value[p * max_functions + a] = shape.value[a];
      for (std::size_t k = 0; k < 3; ++k) table.slope[(3 * p + k) * max_functions + a] = shape.slope[a][k];
    }
  }
  return table;
}

/// Least-squares fit of the corner functions to the points, seen at the nodes; a constant where the points are fewer than the corners.
Matrix extrapolation(Cell cell, const SolidRule& rule) {
  const Cell corners = info(cell).linear;
  const Index n = info(corners).nodes, points = rule.points(), nodes = info(cell).nodes;
  if (points < n) return Matrix::Constant(nodes, points, 1.0 / static_cast<double>(points));
  Matrix at_points(points, n), at_nodes(nodes, n);
  for (Index p = 0; p < points; ++p)
    at_points.row(p) = ConstMap(cell_shape(corners, rule.local[static_cast<std::size_t>(p)]).value.data(), n);
  for (Index a = 0; a < nodes; ++a) {
    const auto& x = cell_nodes(cell)[static_cast<std::size_t>(a)];
    at_nodes.row(a) = ConstMap(cell_shape(corners, {x[0], x[1], x[2]}).value.data(), n);
  }
  return at_nodes * Cholesky(at_points.transpose() * at_points).solve(at_points.transpose());
}

SolidTables make_tables(Cell cell) {
  if (info(cell).dimension < 2) return {};
  const auto [stiffness, mass] = solid_degrees(cell);
  SolidTables tables{
      tabulate(cell, cell_rule(cell, stiffness)), tabulate(cell, cell_rule(cell, mass)), tabulate(cell, {{cell_centre(cell)}, {1}}), {}};
  tables.to_nodes = extrapolation(cell, tables.stiffness);
  return tables;
}

}  // namespace

const SolidTables& solid_tables(Cell cell) {
  static const auto all = [] {
    std::array<SolidTables, num_cell_types> tables;
    for (const CellInfo& c : all_cells()) tables[static_cast<std::size_t>(c.cell)] = make_tables(c.cell);
    return tables;
  }();
  return all[static_cast<std::size_t>(cell)];
}

SolidTables part_tables(Cell cell, const CellRule& rule) {
  const SolidRule table = tabulate(cell, rule);
  const Index points = table.points();
  const Vector weight = ConstMap(rule.weight.data(), points);
  return {table, table, {}, Vector::Ones(info(cell).nodes) * (weight / weight.sum()).transpose()};
}

int num_bubbles(Cell cell) {
  return cell == Cell::quad4 ? 2 : cell == Cell::hex8 ? 3 : 0;
}

void add_strain(const PointGradient& at, int dimension, int first, int count, const double* u, Strain& strain) {
  const double *x = at.g[0] + first, *y = at.g[1] + first, *z = at.g[2] + first;
  if (dimension == 2) {
    for (int a = 0; a < count; ++a, u += 2) {
      strain[0] += x[a] * u[0];
      strain[1] += y[a] * u[1];
      strain[3] += y[a] * u[0] + x[a] * u[1];
    }
    return;
  }
  for (int a = 0; a < count; ++a, u += 3) {
    strain[0] += x[a] * u[0];
    strain[1] += y[a] * u[1];
    strain[2] += z[a] * u[2];
    strain[3] += y[a] * u[0] + x[a] * u[1];
    strain[4] += z[a] * u[1] + y[a] * u[2];
    strain[5] += z[a] * u[0] + x[a] * u[2];
  }
}

void add_force(const PointGradient& at, int dimension, int first, int count, const Stress& stress, double* force) {
  const double *x = at.g[0] + first, *y = at.g[1] + first, *z = at.g[2] + first;
  const Stress s = at.volume * stress;
  if (dimension == 2) {
    for (int a = 0; a < count; ++a, force += 2) {
      force[0] += s[0] * x[a] + s[3] * y[a];
      force[1] += s[3] * x[a] + s[1] * y[a];
    }
    return;
  }
  for (int a = 0; a < count; ++a, force += 3) {
    force[0] += s[0] * x[a] + s[3] * y[a] + s[5] * z[a];
    force[1] += s[3] * x[a] + s[1] * y[a] + s[4] * z[a];
    force[2] += s[5] * x[a] + s[4] * y[a] + s[2] * z[a];
  }
}

}  // namespace uplift
