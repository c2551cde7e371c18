#pragma once
#include <string>
#include <vector>

#include "uplift/model/model.h"

namespace uplift {

/// Nodes of solids where a beam ends in a hinge, ascending: no other beam, no support and no rigid body holds its rotation, and the beam
/// does not come along the edges of the solids.
std::vector<int> hinges(const Model& model);

/// "mesh.7" at (2, 0) m, ... and how many more.
std::string named_places(const Model& model, const std::vector<int>& nodes);

}  // namespace uplift
