#pragma once
#include <string>

#include "uplift/io/hdf5/hdf5.h"
#include "uplift/mesh/mesh.h"

namespace uplift {

/// Reads a mesh of a MED file (SALOME, Code_Aster), format 3 and later, unstructured; coordinates are metres.
/// `mesh` picks one by name; empty: the file must hold one only. A mesh of several steps in time must have the step without time.
/// - Cells: PO1, SE2/3, TR3/6, QU4/8/9, TE4/T10, PE6/P15, HE8/H20/H27, in the node order of mesh/cells.h; others are refused by name.
/// - Groups of cells and groups of nodes come from the families; one family may be in several groups. Groups of no family do not exist in
/// MED.
/// - See finish_mesh for unused nodes, orientation and names.
/// Throws InputError with the path of the object in the file.
Mesh read_med(const Hdf5Reader& file, const std::string& mesh = {});

}  // namespace uplift
