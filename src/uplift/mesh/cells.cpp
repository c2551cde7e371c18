#include "uplift/mesh/cells.h"

#include <array>
#include <cassert>

// Numbering: VTK User's Guide, "Cell types" (linear and quadratic), and vtkTriQuadraticHexahedron for the faces of 27-node bricks: nodes 20
// to 25 lie on x-, x+, y-, y+, z-, z+.
namespace uplift {
namespace {

constexpr Cell line_sides[] = {Cell::point, Cell::point};
constexpr int line_corners[] = {0, 1};
constexpr int line_edges[] = {0, 1};

constexpr Cell tri3_sides[] = {Cell::line2, Cell::line2, Cell::line2};
constexpr int tri3_nodes[] = {0, 1, 1, 2, 2, 0};
constexpr Cell tri6_sides[] = {Cell::line3, Cell::line3, Cell::line3};
constexpr int tri6_nodes[] = {0, 1, 3, 1, 2, 4, 2, 0, 5};
constexpr int tri_edges[] = {0, 1, 1, 2, 2, 0};

constexpr Cell quad4_sides[] = {Cell::line2, Cell::line2, Cell::line2, Cell::line2};
constexpr int quad4_nodes[] = {0, 1, 1, 2, 2, 3, 3, 0};
constexpr Cell quad8_sides[] = {Cell::line3, Cell::line3, Cell::line3, Cell::line3};
constexpr int quad8_nodes[] = {0, 1, 4, 1, 2, 5, 2, 3, 6, 3, 0, 7};
constexpr int quad_edges[] = {0, 1, 1, 2, 2, 3, 3, 0};

constexpr Cell tet4_sides[] = {Cell::tri3, Cell::tri3, Cell::tri3, Cell::tri3};
constexpr int tet4_nodes[] = {0, 1, 3, 1, 2, 3, 2, 0, 3, 0, 2, 1};
constexpr Cell tet10_sides[] = {Cell::tri6, Cell::tri6, Cell::tri6, Cell::tri6};
constexpr int tet10_nodes[] = {0, 1, 3, 4, 8, 7, 1, 2, 3, 5, 9, 8, 2, 0, 3, 6, 7, 9, 0, 2, 1, 6, 5, 4};
constexpr int tet_edges[] = {0, 1, 1, 2, 2, 0, 0, 3, 1, 3, 2, 3};

constexpr Cell wedge6_sides[] = {Cell::tri3, Cell::tri3, Cell::quad4, Cell::quad4, Cell::quad4};
constexpr int wedge6_nodes[] = {0, 2, 1, 3, 4, 5, 0, 1, 4, 3, 1, 2, 5, 4, 2, 0, 3, 5};
constexpr Cell wedge15_sides[] = {Cell::tri6, Cell::tri6, Cell::quad8, Cell::quad8, Cell::quad8};
constexpr int wedge15_nodes[] = {0, 2, 1, 8, 7,  6,           //
                                 3, 4, 5, 9, 10, 11,          //
                                 0, 1, 4, 3, 6,  13, 9,  12,  //
                                 1, 2, 5, 4, 7,  14, 10, 13,  //
                                 2, 0, 3, 5, 8,  12, 11, 14};
constexpr int wedge_edges[] = {0, 1, 1, 2, 2, 0, 3, 4, 4, 5, 5, 3, 0, 3, 1, 4, 2, 5};

constexpr Cell hex8_sides[] = {Cell::quad4, Cell::quad4, Cell::quad4, Cell::quad4, Cell::quad4, Cell::quad4};
constexpr int hex8_nodes[] = {0, 4, 7, 3, 1, 2, 6, 5, 0, 1, 5, 4, 3, 7, 6, 2, 0, 3, 2, 1, 4, 5, 6, 7};
constexpr Cell hex20_sides[] = {Cell::quad8, Cell::quad8, Cell::quad8, Cell::quad8, Cell::quad8, Cell::quad8};
constexpr int hex20_nodes[] = {0, 4, 7, 3, 16, 15, 19, 11,  //
                               1, 2, 6, 5, 9,  18, 13, 17,  //
                               0, 1, 5, 4, 8,  17, 12, 16,  //
                               3, 7, 6, 2, 19, 14, 18, 10,  //
                               0, 3, 2, 1, 11, 10, 9,  8,   //
                               4, 5, 6, 7, 12, 13, 14, 15};
constexpr Cell hex27_sides[] = {Cell::quad9, Cell::quad9, Cell::quad9, Cell::quad9, Cell::quad9, Cell::quad9};
constexpr int hex27_nodes[] = {0, 4, 7, 3, 16, 15, 19, 11, 20,  //
                               1, 2, 6, 5, 9,  18, 13, 17, 21,  //
                               0, 1, 5, 4, 8,  17, 12, 16, 22,  //
                               3, 7, 6, 2, 19, 14, 18, 10, 23,  //
                               0, 3, 2, 1, 11, 10, 9,  8,  24,  //
                               4, 5, 6, 7, 12, 13, 14, 15, 25};
constexpr int hex_edges[] = {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4, 0, 4, 1, 5, 2, 6, 3, 7};

constexpr std::array<CellInfo, num_cell_types> table{{
    {Cell::point, "point", 0, 1, 1, 1, Cell::point, {}, {}, {}},
    {Cell::line2, "line2", 1, 2, 2, 3, Cell::line2, line_sides, line_corners, line_edges},
    {Cell::line3, "line3", 1, 3, 2, 21, Cell::line2, line_sides, line_corners, line_edges},
    {Cell::tri3, "tri3", 2, 3, 3, 5, Cell::tri3, tri3_sides, tri3_nodes, tri_edges},
    {Cell::tri6, "tri6", 2, 6, 3, 22, Cell::tri3, tri6_sides, tri6_nodes, tri_edges},
    {Cell::quad4, "quad4", 2, 4, 4, 9, Cell::quad4, quad4_sides, quad4_nodes, quad_edges},
    {Cell::quad8, "quad8", 2, 8, 4, 23, Cell::quad4, quad8_sides, quad8_nodes, quad_edges},
    {Cell::quad9, "quad9", 2, 9, 4, 28, Cell::quad4, quad8_sides, quad8_nodes, quad_edges},
    {Cell::tet4, "tet4", 3, 4, 4, 10, Cell::tet4, tet4_sides, tet4_nodes, tet_edges},
    {Cell::tet10, "tet10", 3, 10, 4, 24, Cell::tet4, tet10_sides, tet10_nodes, tet_edges},
    {Cell::wedge6, "wedge6", 3, 6, 6, 13, Cell::wedge6, wedge6_sides, wedge6_nodes, wedge_edges},
    {Cell::wedge15, "wedge15", 3, 15, 6, 26, Cell::wedge6, wedge15_sides, wedge15_nodes, wedge_edges},
    {Cell::hex8, "hex8", 3, 8, 8, 12, Cell::hex8, hex8_sides, hex8_nodes, hex_edges},
    {Cell::hex20, "hex20", 3, 20, 8, 25, Cell::hex8, hex20_sides, hex20_nodes, hex_edges},
    {Cell::hex27, "hex27", 3, 27, 8, 29, Cell::hex8, hex27_sides, hex27_nodes, hex_edges},
}};

}  // namespace

const CellInfo& info(Cell cell) {
  return table[static_cast<std::size_t>(cell)];
}

std::span<const CellInfo> all_cells() {
  return table;
}

std::span<const int> side_of(Cell cell, int side) {
  const CellInfo& type = info(cell);
  assert(side >= 0 && side < static_cast<int>(type.sides.size()));
  std::size_t begin = 0;
  for (int k = 0; k < side; ++k) begin += static_cast<std::size_t>(info(type.sides[static_cast<std::size_t>(k)]).nodes);
  return type.side_nodes.subspan(begin, static_cast<std::size_t>(info(type.sides[static_cast<std::size_t>(side)]).nodes));
}

}  // namespace uplift
