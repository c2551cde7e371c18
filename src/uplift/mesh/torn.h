#pragma once
#include <span>
#include <vector>

#include "uplift/mesh/split.h"

namespace uplift {

/// Where cells of full dimension lie side by side and do not share the side between them: the middles [m] of the sides without a cell
/// beyond that lie in another such side, within 1e-6 of its size. Their nodes are there twice (doubled by CAD), or the cells do not match:
/// of first degree beside second, small beside large, the quadrilateral of a hexahedron beside triangles of tetrahedra. Of two sides at the
/// same place, corner by corner, one counts. Sides whose corners all belong to `opened` faces, or to the `joined` nodes of pairs and lines,
/// are meant to be so.
std::vector<Vec3> torn_sides(const Mesh& mesh, const std::vector<std::vector<FacePair>>& opened, std::span<const int> joined = {});

}  // namespace uplift
