#pragma once
#include "uplift/interface/facets.h"
#include "uplift/mesh/cut.h"

namespace uplift {

/// Joint points on the faces that a plane has cut into a mesh. Either side follows the nodes of its cell by the cell's shape functions
/// (docs/theory/cut_elements.md). On level faces (CutFace::level) the points stand at the corners of the face, which neighbours share:
/// in rectangles and hexahedra tractions do not oscillate there, however stiff the joint. On inclined ones the shape functions are
/// quadratic along the face in the plane, cubic in space: Simpson's rule, on parallelograms the corners and the middle; else on triangles
/// the rule of seven points (degree 3) with the corners and the middles of the sides. Faces of cells of the second degree have Simpson's
/// and that of triangles too, with four corners Simpson's in both directions. Normals are that of the plane. `thickness` [m] multiplies the
/// lengths of plane meshes.
struct CutJoints {
  std::vector<JointPoint> points;  // in the plane along the line; in space by rows of growing t2, then t1 (local_axis)
  Facets facets;
  bool inclined = false;   // some face is not level
  bool simplices = false;  // some face passes through a triangle or a tetrahedron
};
/// Whether the plane passes through the cell, not along one of its sides.
bool is_crossed(const Mesh& mesh, CellId cell, const CutFace& face);

CutJoints cut_joints(const Mesh& mesh, const std::vector<CutFace>& faces, const Vec3& normal, double thickness, double gap);

/// What the jump between both sides may be within a cell of its own doubles (CutPlane::own_doubles).
enum class JumpShape { constant, rigid };

/// A linear equation between displacements of nodes of the mesh: sum of factor x component = 0. The first one is that of a double.
struct JumpTerm {
  int node = 0, component = 0;
  double factor = 0;
};
using JumpEquation = std::vector<JumpTerm>;

/// What makes the jump of a cut cell of the plane constant, or a rigid motion of one side against the other: then both sides have one
/// strain, and the cell is that of the element-condensed discontinuity "KOS" (docs/theory/element_jumps.md). `normal`: of the plane.
std::vector<JumpEquation> jump_equations(const Mesh& mesh, const CutFace& face, const Vec3& normal, JumpShape shape);

}  // namespace uplift
