#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/dynamics/step_level.h"
#include "uplift/math/small.h"

namespace uplift {

/// Velocity, acceleration and contact force of a step are corrected by the rule of impact, for the points that are pressed at its end:
/// those of constraints, or of stiff laws where there is no constraint.
void Stepper::apply_impact(Level& level) {
  const InterfaceProblem& problem = *last_;
  const double nothing = 1e-12 * contact_.cwiseAbs().maxCoeff();
  const bool constrained = std::ranges::any_of(problem.blocks, [](const Block& block) { return block.cone != nullptr; });
  bool any_pressed = false;
  pressed_.setZero();
  tangents_.clear();
  for (const Block& block : problem.blocks) {
    if (constrained && block.cone == nullptr) continue;  // a law beside constraints gives way
    const int n = block.batch.points, normal = block.first + block.batch.normal();
    const double *force = contact_.data() + normal, *area = row_area_.data() + normal;
    double* weight = pressed_.data() + normal;
    LaneMask some(false);
    for_lanes(n, [&](const auto& at) {
      const LaneMask pushes = -at(force) > nothing;
      at.put(weight, choose(pushes, at(area), Lanes(0)));
      some = some || pushes;
    });
    any_pressed = any_pressed || any(some);
    const double friction = block.cone != nullptr ? block.cone->friction() : 0;
    if (!(friction > 0)) continue;
    for (int i = 0; i < n; ++i) {
      if (!(weight[i] > 0)) continue;
      double tangential = 0;  // the norm of both directions: a point that slides along a slanted line does not stick in either
      for (int c = 0; c < block.batch.components - 1; ++c) tangential = std::hypot(tangential, contact_[block.first + c * n + i]);
      if (!(tangential < friction * -force[i] * (1 - 1e-9))) continue;
      for (int c = 0; c < block.batch.components - 1; ++c) tangents_.push_back(block.first + c * n + i);
    }
  }
  if (!any_pressed) return;
  const double weight = (1 - options_.scheme.alpha_f) / (1 - options_.scheme.alpha_m);
  Impact data;
  data.mass = mass_spread_.get();
  data.dynamic = level.dynamic.get();
  data.b = bulk_.small ? &dense_b_ : nullptr;
  data.sparse_b = &b_;
  data.pressed = &pressed_;
  std::swap(data.tangents, tangents_);
  data.force = &contact_;
  data.step = level.step;
  data.velocity_weight = options_.scheme.gamma * level.step * weight;
  data.acceleration_weight = weight;
  data.area = &row_area_;
  const double before = 0.5 * small::dot(next_.velocity.size(), next_.velocity.data(), momentum_next_.data());
  impulse_.setZero();
  impact_.apply(data, next_.velocity, next_.acceleration, impulse_, impact_scratch_);
  std::swap(data.tangents, tangents_);
  bulk_.mass.multiply(next_.velocity, momentum_next_);
  impact_loss_ += before - 0.5 * small::dot(next_.velocity.size(), next_.velocity.data(), momentum_next_.data());
  if (impact_.force_includes_impulse())
    for (Eigen::Index i = 0; i < contact_.size(); ++i) contact_[i] += impulse_[i] / level.step;
}

}  // namespace uplift
