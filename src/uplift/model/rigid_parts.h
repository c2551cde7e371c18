#pragma once
#include <vector>

#include "uplift/model/model.h"

namespace uplift {

/// Nodes that move as one rigid body in every motion without strain energy: solids that are connected through faces (in the plane: edges),
/// or beams that are connected at nodes. An inextensible beam counts, since a constraint keeps its length.
struct RigidPart {
  std::vector<int> nodes;  // ascending
  bool beams = false;      // the rotations of the nodes follow the part, too
  bool massive = false;    // a solid with mass: every motion of the part has kinetic energy
  Vec3 middle = Vec3::Zero();
};
/// A node may belong to several parts: it is then a hinge between them.
std::vector<RigidPart> rigid_parts(const Model& model);

/// Whether rigid ties make each node follow another.
std::vector<bool> tied_nodes(const Model& model);
/// Whether nodes move as one body: a single one, or tied ones. `tied`: tied_nodes().
bool is_one_body(const std::vector<int>& nodes, const std::vector<bool>& tied);

/// Whether each free unknown is a translation of a node with a part of a solid's mass matrix, which is positive definite.
std::vector<char> moved_by_solid_mass(const Model& model);

}  // namespace uplift
