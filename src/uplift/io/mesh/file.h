#pragma once
#include <string>

#include "uplift/base/error.h"
#include "uplift/mesh/mesh.h"

namespace uplift {

/// Reads a mesh of Gmsh (.msh 4.1 or 2.x, text or binary) or MED (3 or later): which one, the content decides. Coordinates are metres.
/// `where`: the place that names the file, for the message when it is missing or no mesh; trouble inside is reported with the line, byte or
/// object of the file. `mesh`: the one to take when a MED file holds several. `isolated`: MED files are read in a child process, see
/// med_file.h. Throws InputError. Shapes of cells are checked by check_mesh.
Mesh read_mesh(const std::string& path, const Where& where, const std::string& mesh = {}, bool isolated = true);

}  // namespace uplift
