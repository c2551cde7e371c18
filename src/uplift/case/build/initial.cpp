#include <optional>

#include "uplift/case/build/model.h"
#include "uplift/model/prescribed_values.h"

// Initial displacements and velocities of nodes and groups.
namespace uplift {
namespace {

/// A translation and a rotation about the axes, as [[initial]] gives them; null where it does not.
struct RigidMotion {
  std::optional<Vec3> translation, rotation;
};

RigidMotion motion_from(const Values& initial, const char* translation, const char* rotation, const char* rotations, Space space) {
  RigidMotion motion;
  if (initial.has(translation)) motion.translation = vector_of(initial, translation, space);
  if (initial.has(rotation) || initial.has(rotations)) motion.rotation = about_axes(initial, rotation, rotations, false, space);
  return motion;
}

/// The point about which the nodes of a group rotate.
Vec3 centre_of(const Values& initial, const std::vector<int>& nodes, const CaseNames& names) {
  if (initial.has("centre")) return vector_of(initial, "centre", names.space);
  Vec3 sum = Vec3::Zero();
  for (const int node : nodes) sum += names.positions[static_cast<std::size_t>(node)];
  return sum / static_cast<double>(nodes.size());
}

/// A node alone takes its translation and its rotation as they are given. A group moves as a rigid body; the nodes of solids have no
/// rotation.
void prescribe(const Values& initial, const RigidMotion& motion, const CaseNames& names, std::vector<PrescribedValue>& values) {
  const Space space = names.space;
  const std::vector<int> nodes = names.node_or_group(initial);
  const bool group = initial.has("group"), turning = group && motion.rotation;
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

void add_initial(const Values& root, const CaseNames& names, BuiltCase& built) {
  std::vector<PrescribedValue> displacement, velocity;
  for (const Values& initial : root.tables("initial")) {
    const RigidMotion moved = motion_from(initial, "displacement", "rotation", "rotations", names.space);
    const RigidMotion moving = motion_from(initial, "velocity", "angular_velocity", "angular_velocities", names.space);
    if (initial.has("centre") && !(initial.has("group") && (moved.rotation || moving.rotation)))
      fail(initial, "centre", "centre with a group that rotates", "centre without a group or without a rotation");
    prescribe(initial, moved, names, displacement);
    prescribe(initial, moving, names, velocity);
  }
  if (!displacement.empty()) built.plan.initial_displacement = free_values(built.model, displacement);
  if (!velocity.empty()) built.plan.initial_velocity = free_values(built.model, velocity);
}

}  // namespace uplift
