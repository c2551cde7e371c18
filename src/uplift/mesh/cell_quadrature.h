#pragma once
#include <array>
#include <vector>

#include "uplift/math/linalg.h"
#include "uplift/mesh/cells.h"

namespace uplift {

/// A rule on a reference cell (mesh/cell_shapes.h): sum of weight * f(point). The weights are positive and add up to the size of the
/// reference cell: 1 point, 2 line, 1/2 triangle, 4 quad, 1/6 tet, 1 wedge, 8 hex.
struct CellRule {
  std::vector<Vec3> point;
  std::vector<double> weight;
};

/// Exact for polynomials of `degree` >= 0: in each direction for lines, quads, hexes and the upright direction of wedges (Gauss-Legendre
/// products), in total for triangles and tets. Triangles: 1, 3, 6, 7 points for degrees 1, 2, 4, 5 (Strang & Fix; Cowper, IJNME 7 (1973)
/// 405-408); tets: 1, 4, 14 points for degrees 1, 2, 5 (Walkington, CMU report 00-NA-006 (2000)), 24 for degree 6 (Keast, CMAME 55 (1986)
/// 339-348); above, in triangles above 5, products of Gauss rules on the collapsed square or cube (Stroud 1971). All points are inside.
CellRule cell_rule(Cell cell, int degree);

/// Degrees of the rules with which solids integrate their stiffness and their mass (elements/solid.h).
std::array<int, 2> solid_degrees(Cell cell);

/// The rule of joints and of diagonal matrices, for points, lines and surface cells. Points 0 ... nodes - 1 are the nodes in their order.
///   line2, quad4   trapezoidal (degree 1 in each direction)      line3, quad9   Simpson (degree 3 in each direction)
///   tri3           corners (degree 1)
///   quad8          Simpson too: the centre is a ninth point. The rule of the eight nodes alone has negative weights at the corners.
///   tri6           corners 1/40, mid-sides 1/15 and the centre 9/40 (degree 3). With the six nodes alone the corners would weigh nothing.
/// With every one of them the sum of weight * N_a is the exact integral of the shape function N_a (on an affine cell), so that a uniform
/// traction between two bodies is met at every point.
CellRule nodal_rule(Cell cell);

}  // namespace uplift
