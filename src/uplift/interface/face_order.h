#pragma once
#include "uplift/interface/face_joint.h"

// The order in which the points of a surface are numbered: FaceJoints says which.
namespace uplift {

/// The numbers of the points in their new order. Plane meshes: along the lines that the faces form.
std::vector<int> order_along_lines(const Mesh& mesh, const std::vector<FacePair>& faces, FaceQuadrature quadrature,
                                   const FaceJoints& joints);
/// Meshes in space.
std::vector<int> order_in_rows(const std::vector<JointPoint>& points);
/// Point order[i] becomes point i.
void renumber(const std::vector<int>& order, FaceJoints& joints);

}  // namespace uplift
