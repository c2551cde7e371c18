#pragma once
#include <span>
#include <vector>

#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/half_space.h"
#include "uplift/mesh/placed_cell.h"

// Parts of linear cells on one side of planes.
namespace uplift {

/// Whether a half-space holds all of a cell, none of it or a part. Corners within `tolerance` [m] of the plane count as on it.
enum class PlaneSide { inside, outside, both };
PlaneSide side_of_cell(const HalfSpace& space, std::span<const Vec3> corners, double tolerance);

/// The rule over the part of a linear cell within half-spaces, in local coordinates; the weights add up to the part's share of the measure
/// of the reference cell. Exact for the mass of cells in the plane and of hexahedra, and for the stiffness of all cells, with parallel
/// sides. Where the sides are parallel and every plane is parallel to two of them, the part is a box and has the Gauss rule of a whole
/// cell. A box that one inclined plane ends, across all of its edges in one direction, has Gauss points between its ends; every other part
/// is divided into simplices. Empty when nothing is left.
CellRule rule_within(const PlacedCell& cell, std::span<const HalfSpace> within, double tolerance);

/// The same part as it is drawn: boxes, also those with an inclined end, as one cell, even where warped faces make the part another one;
/// else simplices.
struct DrawnPart {
  Cell piece = Cell::point;
  std::vector<Vec3> corners = {};  // m; of the pieces, piece after piece; none when nothing is left
  std::vector<Vec3> local = {};    // local coordinates of the corners of one box; empty for simplices
};
/// Replaces `made`, whose memory stays.
void draw_within(const PlacedCell& cell, std::span<const HalfSpace> within, double tolerance, DrawnPart& made);
/// Whether nothing is left.
bool is_clipped_away(const PlacedCell& cell, std::span<const HalfSpace> within, double tolerance);

/// Whether shape functions of the cell are at most linear along each edge of the section by these planes, and bilinear on it: sections of
/// triangles and tets, and those parallel to the sides of cells whose sides are parallel.
bool is_level(const PlacedCell& cell, const HalfSpace& plane);

}  // namespace uplift
