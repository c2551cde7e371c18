#include "uplift/io/mesh/gmsh_types.h"

#include <array>
#include <string_view>

// Numbers and node orders: Gmsh reference manual, "Node ordering" and "MSH file format". Gmsh sorts the middles of edges by the smaller end
// (an edge list of each shape), VTK goes around the base, around the top and then up.
namespace uplift {
namespace {

constexpr int gmsh_tet10[] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
constexpr int gmsh_wedge15[] = {0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11};
// Its first twenty: hex20. Faces in Gmsh: z-, y-, x-, x+, y+, z+; in VTK: x-, x+, y-, y+, z-, z+.
constexpr int gmsh_hex27[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26};

constexpr std::array<GmshType, num_cell_types> gmsh_types{{
    {15, Cell::point, {}},
    {1, Cell::line2, {}},
    {8, Cell::line3, {}},
    {2, Cell::tri3, {}},
    {9, Cell::tri6, {}},
    {3, Cell::quad4, {}},
    {16, Cell::quad8, {}},
    {10, Cell::quad9, {}},
    {4, Cell::tet4, {}},
    {11, Cell::tet10, gmsh_tet10},
    {6, Cell::wedge6, {}},
    {18, Cell::wedge15, gmsh_wedge15},
    {5, Cell::hex8, {}},
    {17, Cell::hex20, std::span<const int>(gmsh_hex27).first(20)},
    {12, Cell::hex27, gmsh_hex27},
}};

struct OtherGmshType {
  int number;
  std::string_view name;
};
constexpr OtherGmshType other_gmsh_types[] = {{7, "5-node pyramid"},
                                              {13, "18-node wedge"},
                                              {14, "14-node pyramid"},
                                              {19, "13-node pyramid"},
                                              {20, "9-node triangle"},
                                              {21, "10-node triangle"},
                                              {22, "12-node triangle"},
                                              {23, "15-node triangle"},
                                              {24, "15-node triangle"},
                                              {25, "21-node triangle"},
                                              {26, "4-node line"},
                                              {27, "5-node line"},
                                              {28, "6-node line"},
                                              {29, "20-node tetrahedron"},
                                              {30, "35-node tetrahedron"},
                                              {31, "56-node tetrahedron"},
                                              {34, "polygon"},
                                              {35, "polyhedron"},
                                              {36, "16-node quadrilateral"},
                                              {37, "25-node quadrilateral"},
                                              {38, "36-node quadrilateral"},
                                              {39, "12-node quadrilateral"},
                                              {90, "40-node wedge"},
                                              {91, "75-node wedge"},
                                              {92, "64-node hexahedron"},
                                              {93, "125-node hexahedron"},
                                              {118, "30-node pyramid"},
                                              {119, "55-node pyramid"}};

}  // namespace

const GmshType* gmsh_type(int number) {
  for (const GmshType& type : gmsh_types)
    if (type.number == number) return &type;
  return nullptr;
}

std::string gmsh_type_name(int number) {
  std::string suffix = "type " + std::to_string(number);
  if (const GmshType* known = gmsh_type(number)) return std::string(info(known->cell).name) + " (" + suffix + ")";
  for (const OtherGmshType& other : other_gmsh_types)
    if (other.number == number) return "a " + std::string(other.name) + " (" + suffix + ")";
  return suffix;
}

}  // namespace uplift
