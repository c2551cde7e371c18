#pragma once
#include <vector>

#include "uplift/elements/material.h"
#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cells.h"

// Inside of the solid elements: what depends on the cell type only, computed once per type, and the gradients at a point.
namespace uplift {

/// Room for the shape functions of a hex27, or of a hex8 and its bubbles, filled up to whole vector registers.
inline constexpr int max_functions = 32;

/// Shape functions at the points of one rule. Row of point p: `slope[(3 p + k) * max_functions + a]` = dN_a/dr_k; zero behind the last
/// node.
struct SolidRule {
  std::vector<Vec3> local;
  std::vector<double> weight, value, slope;
  int points() const { return static_cast<int>(weight.size()); }
  const double* values(int point) const { return value.data() + static_cast<std::ptrdiff_t>(point) * max_functions; }
  const double* slopes(int point, int k) const { return slope.data() + (3 * static_cast<std::ptrdiff_t>(point) + k) * max_functions; }
};

struct SolidTables {
  SolidRule stiffness, mass, centre;
  Matrix to_nodes;  // nodal values from those at the points of `stiffness`
};
const SolidTables& solid_tables(Cell cell);
/// Those of a cell that is filled in part, for the rule of the part: one rule for stiffness and mass; nodes get the mean of the points.
SolidTables part_tables(Cell cell, const CellRule& rule);

/// g[i][a] = dN_a/dx_i [1/m] of the nodes, then of the bubbles; `volume`: what the point stands for [m3].
struct PointGradient {
  double volume;
  alignas(64) double g[3][max_functions];
};

/// Strain of displacements u[Dim a + i] of functions `first` ... `first + count - 1`, added to `strain`.
void add_strain(const PointGradient& at, int dimension, int first, int count, const double* u, Strain& strain);
/// force[Dim a + i] += volume * sum_j stress_ij g_j[a] for the same functions.
void add_force(const PointGradient& at, int dimension, int first, int count, const Stress& stress, double* force);

/// Bubbles of a cell: its dimension for quad4 and hex8, else 0.
int num_bubbles(Cell cell);

}  // namespace uplift
