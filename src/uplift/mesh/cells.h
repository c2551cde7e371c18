#pragma once
#include <span>
#include <string_view>

namespace uplift {

/// Cell types. Nodes are numbered as in VTK: corners, then middles of edges, of faces, of the cell; surfaces counter-clockwise; volumes
/// with the corners of the bottom counter-clockwise seen from the top, so that the Jacobian is positive. That holds for wedges too, which
/// Gmsh and all common writers number so, while VTK's own manual turns the triangle 0-1-2 round.
enum class Cell : unsigned char { point, line2, line3, tri3, tri6, quad4, quad8, quad9, tet4, tet10, wedge6, wedge15, hex8, hex20, hex27 };
inline constexpr int num_cell_types = 15;

struct CellInfo {
  Cell cell;
  std::string_view name;
  int dimension;  // 0 point, 1 line, 2 surface, 3 volume
  int nodes;
  int corners;
  int vtk;                      // VTK's number of the type
  Cell linear;                  // the type of its corners alone
  std::span<const Cell> sides;  // types of its sides (faces in 3D, edges in 2D, end points in 1D), same degree
  /// Nodes of all sides, one after another. A face is counter-clockwise seen from outside, so its normal points out of the cell; an edge of
  /// a surface has the surface on its left, so (dy, -dx) points out.
  std::span<const int> side_nodes;
  std::span<const int> edges;  // pairs of corners, in the order of the nodes in the middles of edges of the types of second degree
};
const CellInfo& info(Cell cell);
std::span<const CellInfo> all_cells();
/// Nodes of one side: a part of `side_nodes`.
std::span<const int> side_of(Cell cell, int side);

}  // namespace uplift
