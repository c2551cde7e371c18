#pragma once
#include <span>
#include <vector>

#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/mesh.h"

// Cells that are filled in part, as they are drawn and as users see them.
namespace uplift {

/// The rule over the part of a cell that has one, in the cell's local coordinates: the weights add up to the part's share of the reference
/// cell. Made anew: that of a part in simplices has up to hundreds of points.
CellRule rule_of_part(const Mesh& mesh, CellId id);

/// Gives the parts of a mesh the nodes of their pieces, with followers at the corners that are no nodes.
void add_pieces(Mesh& mesh);

/// The mesh as it is drawn: parts are replaced by their pieces. Nodes keep their numbers.
Mesh drawn_mesh(const Mesh& mesh);

/// Nodes that stand outside of all cells that use them: doubles beyond the plane with nothing of their side around them.
std::vector<bool> bare_nodes(const Mesh& mesh);

}  // namespace uplift
