#pragma once
#include <string>
#include <vector>

#include "uplift/mesh/split.h"

namespace uplift {

/// Pairs the faces (edges in plane meshes) of two groups that are drawn apart: every node of one lies opposite to a node of the other along
/// the mean normal of the lower group, within a thousandth of the shortest edge. The nodes of the faces are renumbered in corresponding
/// order, with the normal out of the lower side. Throws InputError: a group absent or of something else, faces between two cells, a group
/// whose normals turn by more than about 60 degrees from their mean, nodes or faces without a partner.
std::vector<FacePair> facing_pairs(Mesh& mesh, const std::string& lower, const std::string& upper, const Where& where);

}  // namespace uplift
