#pragma once
#include "uplift/interface/joint.h"
#include "uplift/mesh/split.h"

namespace uplift {

enum class FaceQuadrature {
  nodal,  // points at the node pairs (and, for quad8 and tri6, at the centre): diagonal matrices, no traction oscillation for stiff joints
  gauss   // exact for the products of two shape functions on faces with straight (parallel, for quadrilaterals) sides; see below
};

/// Joint points on the faces of a surface that was opened: edges (line2, line3) of a plane mesh, faces (tri3, tri6, quad4, quad8, quad9) of
/// a mesh in space. Positions and normals come from the lower side's geometry; the normal points from lower to upper. With the nodal rule
/// the shares of neighbouring faces in a common pair become one point where their normals agree; the edge between the bottom and a wall
/// gets one point for each normal, a corner of a raft in space three. Nodes where the surface ends inside the continuum carry no point, nor
/// does a face that has only such nodes. `thickness` [m] multiplies the areas of plane meshes.
///
/// On curved and distorted faces, too, a uniform pressure is met exactly with the Gauss rule: the sum of area * normal * N_a is the
/// integral of N_a over the vector of area. With the nodal rule that holds on faces with parallel sides; the sum over all points of area *
/// normal, the resultant of the pressure, is exact on every face.
///
/// Points are numbered along the line in the plane, from its end with the smaller x (then the smaller y), one line after another. In space
/// they are numbered in rows: those of an upward normal first, then each further direction of the normal; within them by rows of growing t2
/// (local_axis), along each row by growing t1.
struct FaceJoints {
  std::vector<JointPoint> points;
  /// For each face the number of the point at each point of its rule (nodal: its nodes first); -1 where there is none.
  std::vector<std::vector<int>> of_face;
};
FaceJoints face_joints(const Mesh& mesh, const std::vector<FacePair>& faces, FaceQuadrature quadrature, double thickness, double gap);
/// Its points alone.
std::vector<JointPoint> face_points(const Mesh& mesh, const std::vector<FacePair>& faces, FaceQuadrature quadrature, double thickness,
                                    double gap);

}  // namespace uplift
