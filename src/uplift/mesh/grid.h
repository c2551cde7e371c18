#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/mesh/mesh.h"

// Structured meshes on straight lines.
namespace uplift {

// ---- lines of one axis: ascending coordinates [m] ----

/// A stretch of an axis that ends at `to` [m]; its cells are not longer than `size` [m].
struct Stretch {
  double to = 0, size = 1;
};
/// Stretches one after another from `from`; all ends are met exactly. Where stretches meet, cells start with the smaller size of the two
/// and grow by at most the factor `growth` > 1 from cell to cell up to their own size, so that fine stretches fade into coarse ones.
std::vector<double> graded_lines(double from, const std::vector<Stretch>& stretches, double growth);

// ---- grids ----

/// Lines of the axes; no lines along z: plane.
struct Grid {
  std::vector<double> x, y, z;
  int dimension() const { return z.empty() ? 2 : 3; }
};
/// Sides of a grid cell. In plane grids bottom and top are along y, otherwise along z, and y goes from front to back.
enum class Direction { left, right, front, back, bottom, top };
std::string_view name_of(Direction direction);  // "left", ...

/// The part of the grid cell (i, j, k) (k = 0 in plane grids): a number in `names`, -1 where there is nothing.
using PartOf = std::function<int(int i, int j, int k)>;
/// The group of a face of a cell of `part` towards `other` (-1: nothing); empty: no group. Asked from both sides.
using FaceName = std::function<std::string(int part, Direction direction, int other)>;

/// Mesh of quadrilaterals or bricks in those cells of the grid that belong to a part: a group for each part, groups of faces as named, each
/// face numbered with its normal out of the cell whose part was asked. Nodes are numbered x fastest, then y, z, without those of no cell.
Mesh grid(const Grid& lines, const PartOf& part_of, const std::vector<std::string>& names, const FaceName& face_name);

/// The same mesh of bricks or quadrilaterals with other cells: any type of the mesh's dimension.
Mesh with_cells(Mesh mesh, Cell cell);

}  // namespace uplift
