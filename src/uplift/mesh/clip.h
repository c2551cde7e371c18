#pragma once
#include <span>
#include <vector>

#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/placed_cell.h"

// Parts of linear cells on one side of planes.
namespace uplift {

/// The points x with normal . x <= level.
struct HalfSpace {
  Vec3 normal = Vec3::Zero();  // unit
  double level = 0;            // m
  double distance(const Vec3& x) const { return normal.dot(x) - level; }
  HalfSpace other_side() const { return {-normal, -level}; }
};

/// Whether a half-space holds all of a cell, none of it or a part. Corners within `tolerance` [m] of the plane count as on it.
enum class PlaneSide { inside, outside, both };
PlaneSide side_of_cell(const HalfSpace& space, std::span<const Vec3> corners, double tolerance);

/// The part of a linear cell within half-spaces.
struct ClippedCell {
  Cell piece = Cell::point;   // it is divided into cells of this type
  CellRule rule;              // of a box, in local coordinates; weights in the measure of the reference cell. Empty: see rule_in_simplices
  std::vector<Vec3> corners;  // m; of the pieces, piece after piece; none when nothing is left
};
/// Where the cell has parallel sides and every plane is parallel to two of them, the part is a box: one piece, and a Gauss rule that is as
/// good as that of the whole cell. Else it is divided into simplices.
ClippedCell clip_cell(const PlacedCell& cell, std::span<const HalfSpace> within, double tolerance);
/// The rule over simplices in a cell, from the corners of one after the other [m]; exact for the mass of cells in the plane with parallel
/// sides and for the stiffness of all cells with parallel sides.
CellRule rule_in_simplices(const PlacedCell& cell, std::span<const Vec3> corners);
/// Whether nothing is left.
bool is_clipped_away(const PlacedCell& cell, std::span<const HalfSpace> within, double tolerance);

/// Whether shape functions of the cell are at most linear along each edge of the section by these planes, and bilinear on it: sections of
/// triangles and tets, and those parallel to the sides of cells whose sides are parallel.
bool is_level(const PlacedCell& cell, const HalfSpace& plane);

/// The section of a cell by a plane: its corners [m], in the plane two, in space in their order round it; those within `tolerance` once.
/// Empty when the plane only touches the cell.
std::vector<Vec3> section(Cell cell, std::span<const Vec3> corners, const HalfSpace& plane, double tolerance);
/// What is left of a section within half-spaces.
std::vector<Vec3> clip_section(std::vector<Vec3> corners, const std::vector<HalfSpace>& within, double tolerance);

}  // namespace uplift
