#pragma once
#include <string>
#include <vector>

#include "uplift/mesh/clip.h"
#include "uplift/mesh/mesh.h"

// Cuts a mesh along planes that its cells ignore, so that both sides can part there (docs/theory/cut_elements.md). A cut cell becomes two
// cells on the same place, one for each side: each has the shape functions of the whole cell, integrated over its side (Hansbo & Hansbo,
// CMAME 193 (2004) 3523-3540; the phantom nodes of Areias & Belytschko, IJNME 66 (2006) 1039-1043). It keeps the nodes on its own side; the
// nodes beyond the plane are doubled, one double for all cells around it.
namespace uplift {

/// What stands on a plane.
struct CutOutline {
  std::vector<HalfSpace> within = {};  // above the plane the groups `through` are filled within all of these; none: everywhere
  std::string upper = {};              // group of what lies above, of a new name or not; empty: what lies above stays in its groups
};

/// A plane and what lies above it.
struct CutPlane {
  std::vector<std::string> through;         // groups of cells that it cuts
  HalfSpace below;                          // the lower side; its normal points from the lower to the upper side
  std::vector<CutOutline> outlines = {{}};  // at least one; what lies above the plane and outside of all of them is not filled
  // The plane cuts the cells within all of these alone; empty: all. Cells beyond are ground that stays as it is: above the plane it ends in
  // walls, from which the structure parts.
  std::vector<HalfSpace> extent = {};
  bool own_doubles = false;  // each cut cell has doubles that no other one knows, and groups have none: see jump_equations
};

/// The part of a plane that one cell, or two cells with a face on the plane, have in common.
struct CutFace {
  CellId lower, upper;
  std::vector<Vec3> corners;  // m; in the plane two, in space three or more in the order of the outline
  // parallel to faces of a cell with parallel sides, as the edges of the outline, or of a triangle or tetrahedron, or a whole face of two
  // cells; of cells of the first degree
  bool level = false;
  bool clipped = false;  // the outline ends inside the cell
  int outline = 0;       // of the plane's, in their order
};

/// A part of the surface that the ground has in the plane beside the outlines, where nothing stands on it: of one cell.
struct FreeFace {
  CellId cell;                // below; the surface follows its nodes by its shape functions
  std::vector<Vec3> corners;  // m; convex: in the plane two, in space three or more in the order of the outline
  Vec3 normal;                // of the plane, out of the ground
};

/// Cuts the mesh and removes what is not filled: cells, and nodes that no cell uses. For each plane its faces.
/// - Cells of the groups `through` alone are cut; all others must lie on one side of the plane, or outside of the outlines.
/// - Nodes within 1e-8 of the shortest edge from a plane count as on it; where all nodes of a face are, the mesh is opened there as by
///   `split`.
/// - Faces (edges in the plane) of groups are cut and removed with their cells; a group of nodes that has a node gets its double too.
///   Cells of lower dimension (beams, points) on the plane go with the upper side.
/// - The limits of an extent run along faces of cells wherever these reach above the plane.
/// Throws InputError: a group absent (with the nearest name) or of something else, cut cells of the second degree, a cell that two planes
/// cut or two outlines share, or that a limit of an extent crosses, a node on a plane whose cells have doubles of their own, a plane that
/// cuts nothing, cells of other groups that meet those of `through` in the plane or stand on what is not filled. The mesh is unchanged
/// then. `lines`: groups of cells of lower dimension that are no faces, as beams; absent ones count as empty. `free`: gets the free faces
/// of each plane.
std::vector<std::vector<CutFace>> cut(Mesh& mesh, const std::vector<CutPlane>& planes, const std::vector<Where>& where,
                                      const std::vector<std::string>& lines = {}, std::vector<std::vector<FreeFace>>* free = nullptr);

}  // namespace uplift
