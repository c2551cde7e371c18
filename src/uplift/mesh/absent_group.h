#pragma once
#include "uplift/base/error.h"
#include "uplift/mesh/mesh.h"

namespace uplift {

/// The error for a group that the mesh does not have: the nearest name, or, where none is near, the names that there are.
InputError absent_group(const Mesh& mesh, const std::string& name, const Where& where, const std::string& path, const std::string& wanted);

}  // namespace uplift
