#pragma once
#include <array>
#include <span>

#include "uplift/math/linalg.h"
#include "uplift/mesh/cells.h"

// Shape functions of every cell type. Reference cells and local coordinates (r, s, t):
//   point      the origin
//   line       r in [-1, 1]
//   triangle   r, s >= 0, r + s <= 1; corners (0,0), (1,0), (0,1)
//   quad       [-1, 1]^2; corners (-1,-1), (1,-1), (1,1), (-1,1)
//   tet        r, s, t >= 0, r + s + t <= 1; corners the origin and the ends of the axes
//   wedge      triangle (r, s) times t in [-1, 1]; corners of t = -1 first
//   hex        [-1, 1]^3; corners of t = -1 first
// Coordinates beyond the cell's dimension are not looked at. Nodes are numbered as in VTK; a cell with a positive Jacobian has its
// triangle or quad 0-1-2(-3) counter-clockwise seen from the side of the other corners.
namespace uplift {

inline constexpr int max_cell_nodes = 27;

/// Shape functions and their local gradients at one point of a cell: complete polynomials (line, triangle, tet), tensor products (quad4,
/// quad9, hex8, hex27), serendipity (quad8, hex20) and wedges (Zienkiewicz & Taylor, The Finite Element Method, vol. 1, chapter 8). They
/// add up to 1 and are 1 at their own node and 0 at the others.
struct CellShape {
  int nodes = 0;
  std::array<double, max_cell_nodes> value{};                 // N_a
  std::array<std::array<double, 3>, max_cell_nodes> slope{};  // dN_a/dr, dN_a/ds, dN_a/dt
};
CellShape cell_shape(Cell cell, const Vec3& local);

/// Local coordinates of the nodes, in their order.
std::span<const std::array<double, 3>> cell_nodes(Cell cell);
/// Local coordinates of the centre.
Vec3 cell_centre(Cell cell);

/// Place of a point of a cell whose nodes lie at `positions` [m].
Vec3 cell_position(const CellShape& shape, std::span<const Vec3> positions);
/// dx/dr_k [m per unit of r_k], k = 0, 1, 2: a column of the Jacobian.
Vec3 cell_tangent(const CellShape& shape, std::span<const Vec3> positions, int k);
/// Vector normal to a surface cell at a point, its length the ratio of the area to that of the reference cell; seen from its tip the nodes
/// run counter-clockwise. For a line in the plane z = 0: dx/dr turned by -90 degrees, which points out of a cell on its left.
Vec3 cell_area_vector(const CellShape& shape, std::span<const Vec3> positions, Cell cell);

}  // namespace uplift
