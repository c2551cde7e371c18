#include <optional>

#include "uplift/case/build/model.h"
#include "uplift/model/prescribed_values.h"

// Initial displacements and velocities of nodes and groups.
namespace uplift {
namespace {

/// The point about which the nodes of a group rotate.
Vec3 centre_of(const CaseInitial& initial, const std::vector<int>& nodes, const CaseNames& names) {
  if (initial.centre) return *initial.centre;
  Vec3 sum = Vec3::Zero();
  for (const int node : nodes) sum += names.positions[static_cast<std::size_t>(node)];
  return sum / static_cast<double>(nodes.size());
}

/// A node alone takes its translation and its rotation as they are given. A group moves as a rigid body; the nodes of solids have no
/// rotation.
void prescribe(const CaseInitial& initial, const CaseInitial::Motion& motion, const CaseNames& names,
               std::vector<PrescribedValue>& values) {
  const Space space = names.space;
  const std::vector<int> nodes = names.nodes_of(initial.of);
  const bool group = initial.of.group.has_value(), turning = group && motion.rotation;
  const std::set<int> with_rotation = turning ? beam_nodes(names) : std::set<int>{};
  const Vec3 centre = turning ? centre_of(initial, nodes, names) : Vec3(Vec3::Zero());
  for (const int node : nodes) {
    Vec3 translation = motion.translation.value_or(Vec3::Zero());
    if (turning) translation += cross(*motion.rotation, Vec3(names.positions[static_cast<std::size_t>(node)] - centre));
    for (int k = 0; k < space.unknowns(); ++k) {
      const bool rotates = space.is_rotation(k);
      const bool given = rotates ? motion.rotation && (!group || with_rotation.contains(node)) : motion.translation || turning;
      if (given)
        values.push_back({space.unknowns() * node + k, (rotates ? *motion.rotation : translation).dot(space.axis(k)), initial.where()});
    }
  }
}

}  // namespace

void add_initial(const CaseInput& input, const CaseNames& names, BuiltCase& built) {
  std::vector<PrescribedValue> displacement, velocity;
  for (const CaseInitial& initial : input.initial) {
    prescribe(initial, initial.displacement, names, displacement);
    prescribe(initial, initial.velocity, names, velocity);
  }
  if (!displacement.empty()) built.plan.initial_displacement = free_values(built.model, displacement);
  if (!velocity.empty()) built.plan.initial_velocity = free_values(built.model, velocity);
}

}  // namespace uplift
