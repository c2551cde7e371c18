#pragma once
#include <array>
#include <span>
#include <vector>

#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cells.h"

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
  CellRule rule;  // in local coordinates; weights in the measure of the reference cell
  struct Piece {
    Cell cell;
    std::vector<Vec3> corners;  // m
  };
  std::vector<Piece> pieces;
};
/// Where the cell has parallel sides and every plane is parallel to two of them, the part is a box: one piece, and a Gauss rule that is as
/// good as that of the whole cell. Else it is divided into simplices; their rules are exact for the mass of cells in the plane with
/// parallel sides and for the stiffness of all cells with parallel sides. Empty when nothing is left.
ClippedCell clip_cell(Cell cell, std::span<const Vec3> corners, const std::vector<HalfSpace>& within, double tolerance);

/// Whether shape functions of the cell are at most linear along each edge of the section by these planes, and bilinear on it: sections of
/// triangles and tets, and those parallel to the sides of cells whose sides are parallel.
bool is_level(Cell cell, std::span<const Vec3> corners, const HalfSpace& plane);

/// The section of a cell by a plane: its corners [m], in the plane two, in space in their order round it; those within `tolerance` once.
/// Empty when the plane only touches the cell.
std::vector<Vec3> section(Cell cell, std::span<const Vec3> corners, const HalfSpace& plane, double tolerance);
/// What is left of a section within half-spaces.
std::vector<Vec3> clip_section(std::vector<Vec3> corners, const std::vector<HalfSpace>& within, double tolerance);

/// Local coordinates of a place in a linear cell; exact for cells with parallel sides and simplices, by Newton's method for others.
Vec3 local_coordinates(Cell cell, std::span<const Vec3> corners, const Vec3& place);

/// The same for many places in one cell: without iterations where its sides are parallel.
class LocalCoordinates {
 public:
  LocalCoordinates(Cell cell, std::span<const Vec3> corners);
  Vec3 operator()(const Vec3& place) const;
  /// Length, area or volume of the cell over that of the reference cell.
  double measure(const Vec3& local) const;

 private:
  Cell cell_;
  std::vector<Vec3> corners_;
  bool parallel_;
  Vec3 origin_, middle_;
  std::array<Vec3, 3> dual_;  // 1/m: gradients of the local coordinates in the middle
  double measure_;            // in the middle
};

}  // namespace uplift
