#include "uplift/dynamics/contact_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/model/base_size.h"

namespace uplift {

ContactRows::ContactRows(const Model& model, const Bulk& bulk, const Sparse& rows, const SupportMotion& supports, Spread spread)
    : b(rows), motion(supports), mass(std::move(spread)), area(rows.rows()), pressed(Vector::Zero(rows.rows())) {
  tangents.reserve(static_cast<std::size_t>(b.rows()));
  Eigen::Index row = 0;
  for (const Interface& interface : model.interfaces)
    for (int i = 0; i < interface.rows(); ++i) area[row++] = interface.area[i % interface.batch.points];
  if (bulk.small) dense_b = Matrix(b);
  if (const double size = base_size(model); size > 0) closed_gap = closed_share * size;
}

bool ContactRows::select_pressed(const std::vector<Block>& blocks, const Vector& forces) {
  Lanes sizes = 0;
  for_lanes(
      forces.size(),
      [&, all = forces.data() ](const auto& at) __attribute__((always_inline)) { sizes = larger(sizes, absolute(at(all))); });
  const double nothing = 1e-12 * largest(sizes);
  const bool constrained = std::ranges::any_of(blocks, [](const Block& block) { return block.cone != nullptr; });
  bool any_pressed = false;
  tangents.clear();
  for (const Block& block : blocks) {
    if (constrained && block.cone == nullptr) continue;  // a law beside constraints gives way
    const int n = block.batch.points, normal = block.first + block.batch.normal();
    const double *force = forces.data() + normal, *weight_of = area.data() + normal;
    double* weight = pressed.data() + normal;
    LaneMask some(false);
    for_lanes(
        n, [&](const auto& at) __attribute__((always_inline)) {
          const LaneMask pushes = -at(force) > nothing;
          at.put(weight, choose(pushes, at(weight_of), Lanes(0)));
          some = some || pushes;
        });
    any_pressed = any_pressed || any(some);
    const double friction = block.cone != nullptr ? block.cone->friction() : 0;
    if (!(friction > 0)) continue;
    for (int i = 0; i < n; ++i) {
      if (!(weight[i] > 0)) continue;
      double tangential = 0;  // the norm of both directions: a point that slides along a slanted line does not stick in either
      for (int c = 0; c < block.batch.components - 1; ++c) tangential = std::hypot(tangential, forces[block.first + c * n + i]);
      if (!(tangential < friction * -force[i] * (1 - 1e-9))) continue;
      for (int c = 0; c < block.batch.components - 1; ++c) tangents.push_back(block.first + c * n + i);
    }
  }
  return any_pressed;
}

Impact ContactRows::impact(const Vector& force) const {
  Impact data;
  data.mass = &mass;
  data.b = dense_b.size() > 0 ? &dense_b : nullptr;
  data.sparse_b = &b;
  data.pressed = &pressed;
  data.tangents = tangents;
  data.force = &force;
  data.area = &area;
  data.moved_velocity = motion.velocity();
  data.moved_acceleration = motion.acceleration();
  return data;
}

}  // namespace uplift
