#pragma once
#include <vector>

#include "uplift/mesh/mesh.h"

// Cells that are filled in part, as they are drawn and as users see them.
namespace uplift {

/// Gives the parts of a mesh the nodes of their pieces, with followers at the corners that are no nodes. `corners`: [m] of the pieces of
/// each part, in the order of the parts' numbers.
void add_pieces(std::vector<std::vector<Vec3>> corners, Mesh& mesh);

/// The mesh as it is drawn: parts are replaced by their pieces. Nodes keep their numbers.
Mesh drawn_mesh(const Mesh& mesh);

/// Nodes that stand outside of all cells that use them: doubles beyond the plane with nothing of their side around them.
std::vector<bool> bare_nodes(const Mesh& mesh);

}  // namespace uplift
