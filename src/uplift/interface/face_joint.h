#pragma once
#include "uplift/interface/joint.h"
#include "uplift/mesh/split.h"

namespace uplift {

enum class FaceQuadrature {
  nodal,  // points at the node pairs (and, for quad8 and tri6, at the centre): diagonal matrices, no traction oscillation for stiff joints
  gauss   // exact for the products of two shape functions on straight-sided faces
};

/// Joint points on the faces of a surface that was opened in a plane mesh. Positions and normals come from the lower side's geometry; the
/// normal points from lower to upper. With the nodal rule the shares of neighbouring faces in a common pair become one point where their
/// normals agree; the corner between the bottom and a wall stays two points, one for each normal. Nodes where the surface ends inside the
/// continuum carry no point. `thickness` [m] multiplies the areas.
std::vector<JointPoint> face_points(const Mesh& mesh, const std::vector<FacePair>& faces, FaceQuadrature quadrature, double thickness,
                                    double gap);

}  // namespace uplift
