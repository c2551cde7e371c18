#include "uplift/dynamics/rigid_motions.h"

namespace uplift {

RigidMotions rigid_motions(const Model& model) {
  const Space space = model.space;
  Vec3 middle = Vec3::Zero();
  for (const Node& node : model.nodes) middle += node.position / static_cast<double>(model.nodes.size());
  RigidMotions all{Matrix(model.free(), space.unknowns()), std::vector<int>(static_cast<std::size_t>(model.free()))};
  Matrix& motions = all.motions;
  for (Index i = 0; i < motions.rows(); ++i) {
    const int full = model.kept[static_cast<std::size_t>(i)], own = space.index_of(full);
    all.node[static_cast<std::size_t>(i)] = space.node_of(full);
    const Vec3 arm = model.nodes[static_cast<std::size_t>(space.node_of(full))].position - middle;
    for (int motion = 0; motion < space.unknowns(); ++motion)
      motions(i, motion) = space.is_rotation(full) ? (motion == own ? 1.0 : 0.0) : space.motion(motion, arm).dot(space.axis(own));
  }
  return all;
}

}  // namespace uplift
