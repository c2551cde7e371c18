#pragma once
#include "uplift/mesh/mesh.h"

namespace uplift {

/// The least Jacobian of a cell and where it occurs.
struct LeastJacobian {
  double value = 0;  // det(dx/dr) over the product of the lengths of the columns dx/dr_k: the same in every unit; <= 0: unusable
  int corner = -1;   // of the cell, from 0; -1: at an integration point
  Vec3 position = Vec3::Zero();  // m
};
/// At the corners of a cell with straight edges, and at the points where solids integrate their stiffness and their mass. For a cell of the
/// mesh's dimension.
LeastJacobian least_jacobian(const Mesh& mesh, CellId id);

}  // namespace uplift
