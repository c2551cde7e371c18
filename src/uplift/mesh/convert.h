#pragma once
#include "uplift/mesh/mesh.h"

// The same mesh with other cells. Groups keep their names; nodes keep their numbers and places, new ones follow; blocks and cells are
// numbered anew.
namespace uplift {

/// Quadrilaterals become triangles; bricks and wedges tetrahedra (six and three). Every quadrilateral face is cut through its lowest node,
/// so that any conforming mesh stays conforming (Dompierre, Labbe, Vallet & Camarero, How to subdivide pyramids, prisms and hexahedra into
/// tetrahedra, 1999). Cells of first degree only.
Mesh to_simplices(const Mesh& mesh);

/// Bricks become two wedges each, cut along the diagonal 0-2 of their bottom; quadrilaterals on bottoms and tops become triangles.
/// Conforming when bricks are numbered alike and stacked bottom on top, as those of grid() are. Cells of first degree only.
Mesh to_wedges(const Mesh& mesh);

/// Nodes in the middles of edges and, when `full`, of quadrilaterals and bricks too: tri6, quad8 or quad9, tet10, wedge15, hex20 or hex27,
/// line3. A full mesh must have no wedges. Cells of first degree only.
Mesh to_second_degree(const Mesh& mesh, bool full);

}  // namespace uplift
