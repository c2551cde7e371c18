#pragma once
#include <string>
#include <string_view>

#include "uplift/io/mesh/gmsh_source.h"
#include "uplift/mesh/mesh.h"

namespace uplift {

/// Does this look like a .msh file? Decided by its first characters.
bool is_gmsh(const GmshSource& source);

/// Reads a mesh of Gmsh, format 4.1 as text or binary, or format 2.x as text; coordinates are metres. The file is read in pieces.
/// - Cells: points, lines 2/3, triangles 3/6, quadrilaterals 4/8/9, tetrahedra 4/10, wedges 6/15, hexahedra 8/20/27, in the node order of
///   mesh/cells.h; other types are refused by name.
/// - Physical groups become named groups; without a name, tag 7 of dimension 2 is called "physical_2_7". Cells without a physical group
///   stay in the mesh. Groups without cells stay, empty. Format 2 writes a cell once for each of its groups: it becomes one cell.
/// - Node tags may be in any order, with gaps. Parameters of nodes on curves and surfaces are skipped, so are periodicity, post-processing
///   data, ghost cells and unknown sections.
/// - See finish_mesh for unused nodes, orientation and names.
/// Throws InputError with the line (text) or byte (binary). Memory stays within a small multiple of the size of the file.
Mesh read_gmsh(const GmshSource& source);
/// The same of a file in memory; `file` is its name in messages.
Mesh read_gmsh(std::string_view bytes, const std::string& file);

}  // namespace uplift
