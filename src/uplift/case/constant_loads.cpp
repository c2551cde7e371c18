#include "uplift/case/constant_loads.h"

#include <cmath>
#include <vector>

#include "uplift/case/case.h"
#include "uplift/case/mesh/mesh.h"

namespace uplift {
namespace {

void add(Thrust& sum, const Thrust& part) {
  sum.force += part.force;
  for (std::size_t k = 0; k < 2; ++k) sum.first[k] += part.first[k];
}

}  // namespace

Thrust thrust_of(Space space, double axial, double moment_1, double moment_2) {
  if (space.dimension == 2) return {-axial, {-moment_1, 0}};
  return {-axial, {moment_2, -moment_1}};
}

double ConstantLoads::lateral() const {
  return std::hypot(all.first[0] - weight.first[0], all.first[1] - weight.first[1]);
}

ConstantLoads constant_loads(const Model& model, const Interface& interface, const InterfaceFacts& facts) {
  constexpr double round_off = 1e-9;
  const Space space = model.space;
  const Vec3 normal = mean_normal(interface), up = model.up();
  const std::vector<char> carried = part_of(model, facts.upper);
  const auto each_carried = [&](const SparseVector& load, const auto& take) {
    for (SparseVector::InnerIterator entry(load); entry; ++entry) {
      const int unknown = static_cast<int>(entry.index()), node = space.node_of(unknown), k = space.index_of(unknown);
      if (carried[static_cast<std::size_t>(node)]) take(node, space.is_rotation(k), Vec3(entry.value() * space.axis(k)));
    }
  };
  const auto thrust = [&](const SparseVector& load, bool vertical) {
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    each_carried(load, [&](int node, bool rotation, Vec3 part) {
      if (rotation) {
        if (!vertical) moment += part;
        return;
      }
      if (vertical) part = part.dot(up) * up;
      force += part;
      moment += cross(model.nodes[static_cast<std::size_t>(node)].position - interface.reference, part);
    });
    const bool plane = space.dimension == 2;
    return thrust_of(space, force.dot(normal), plane ? moment.z() : moment.dot(local_axis(space, normal, 0)),
                     plane ? 0 : moment.dot(local_axis(space, normal, 1)));
  };
  ConstantLoads made;
  for (std::size_t i = 0; i < model.time_loads.size(); ++i) {
    const TimeLoad& load = model.time_loads[i];
    if (!load.dead) continue;
    const SparseVector& pattern = model.assembly.loads[i];
    const Thrust whole = thrust(pattern, false);
    add(made.all, whole);
    const std::string_view water = "water pressure in ";
    const bool is_gravity = i == 0 && !model.assembly.gravity.isZero(), is_water = load.name.starts_with(water);
    if (is_gravity || (is_water && load.name.substr(water.size()) == interface.name)) {
      add(made.weight, whole);
      continue;
    }
    double upwards = 0, size = 0;  // N
    each_carried(pattern, [&](int, bool rotation, const Vec3& part) {
      if (!rotation) upwards += part.dot(up), size += part.norm();
    });
    if (!is_water && upwards < -round_off * size) add(made.weight, thrust(pattern, true));
  }
  return made;
}

}  // namespace uplift
