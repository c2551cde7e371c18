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
  std::size_t count = 0;
  normals_.resize(static_cast<std::size_t>(b_.rows()));
  tangents_.clear();
  for (const Block& block : problem.blocks) {
    if (constrained && block.cone == nullptr) continue;  // a law beside constraints gives way
    const int n = block.batch.points, normal = block.first + block.batch.normal();
    const std::size_t before = count;
    const double* force = contact_.data();
    int* list = normals_.data();
    for (int row = normal; row < normal + n; ++row) {  // without a branch that cannot be foretold
      list[count] = row;
      count += -force[row] > nothing ? 1 : 0;
    }
    const double friction = block.cone != nullptr ? block.cone->friction() : 0;
    if (!(friction > 0)) continue;
    for (std::size_t k = before; k < count; ++k) {
      const int i = normals_[k] - normal;
      double tangential = 0;  // the norm of both directions: a point that slides along a slanted line does not stick in either
      for (int c = 0; c < block.batch.components - 1; ++c) tangential = std::hypot(tangential, contact_[block.first + c * n + i]);
      if (!(tangential < friction * -contact_[normals_[k]] * (1 - 1e-9))) continue;
      for (int c = 0; c < block.batch.components - 1; ++c) tangents_.push_back(block.first + c * n + i);
    }
  }
  normals_.resize(count);
  if (normals_.empty()) return;
  const double weight = (1 - options_.scheme.alpha_f) / (1 - options_.scheme.alpha_m);
  Impact data;
  data.mass = mass_spread_.get();
  data.dynamic = level.dynamic.get();
  data.b = bulk_.small ? &dense_b_ : nullptr;
  data.sparse_b = &b_;
  std::swap(data.normals, normals_);
  std::swap(data.tangents, tangents_);
  data.force = &contact_;
  data.step = level.step;
  data.velocity_weight = options_.scheme.gamma * level.step * weight;
  data.acceleration_weight = weight;
  data.area = &row_area_;
  const double before = 0.5 * small::dot(next_.velocity.size(), next_.velocity.data(), momentum_next_.data());
  impulse_.setZero();
  impact_.apply(data, next_.velocity, next_.acceleration, impulse_, impact_scratch_);
  std::swap(data.normals, normals_);
  std::swap(data.tangents, tangents_);
  bulk_.mass.multiply(next_.velocity, momentum_next_);
  impact_loss_ += before - 0.5 * small::dot(next_.velocity.size(), next_.velocity.data(), momentum_next_.data());
  if (impact_.force_includes_impulse())
    for (Eigen::Index i = 0; i < contact_.size(); ++i) contact_[i] += impulse_[i] / level.step;
}

}  // namespace uplift
