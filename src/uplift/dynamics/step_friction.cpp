#include <algorithm>
#include <cmath>

#include "uplift/contact/impact/projection.h"
#include "uplift/dynamics/step_level.h"

// Impacts of points with friction (docs/theory, section 5): the impulse of friction belongs to the projected normal impulse, not to the
// multiplier of the displacement solve, and the force at the beginning of a step does no work on a point that it no longer holds.
namespace uplift {
namespace {

/// Whether a point with friction is open before or after a step that moves the points.
bool lifted(const std::vector<Block>& blocks, const State& before, const Vector& force, const Vector& opening) {
  constexpr double still = 1e-12;  // m, as far as contact is solved
  if (!((opening - before.opening).cwiseAbs().maxCoeff() > still)) return false;
  return std::ranges::any_of(blocks, [&](const Block& block) {
    if (block.cone == nullptr || !(block.cone->friction() > 0)) return false;
    const int normal = block.first + block.batch.normal();
    for (int row = normal; row < normal + block.batch.points; ++row)
      if (!(before.force[row] < 0) || !(force[row] < 0)) return true;
    return false;
  });
}

}  // namespace

/// The trapezoidal rule gives a point the work (p_0 + p_1) dg/2. With p_0 = 0 it takes energy only; where it is negative p_0 works on a
/// motion that it does not resist. Where some point is open, such forces are taken out of the beginning of the step, which is solved again:
/// all of it at a point that has opened, as much of its friction as is too much at one that has turned round. True when there are any.
bool Stepper::drop_creating() {
  const InterfaceSolution& end = *solution_;
  if (force_before_.size() == 0 && !lifted(last_->model->blocks, now_, end.force, end.opening)) return false;
  const double nothing = 1e-15 * largest_external_;
  Vector dropped;
  for (const Block& block : last_->model->blocks) {
    if (block.cone == nullptr || !(block.cone->friction() > 0)) continue;
    const int n = block.batch.points, normal = block.batch.normal();
    for (int i = block.first; i < block.first + n; ++i) {
      const bool held = end.force[i + normal] < 0;
      double begun = 0, ended = 0;
      const int rows = held ? block.batch.components - 1 : block.batch.components;
      for (int c = 0, row = i; c < rows; ++c, row += n) {
        const double moved = end.opening[row] - now_.opening[row];
        begun += 0.5 * now_.force[row] * moved, ended += 0.5 * end.force[row] * moved;
      }
      if (begun + ended >= -nothing || !(begun < 0)) continue;
      if (dropped.size() == 0) dropped.setZero(now_.force.size());
      const bool again = force_before_.size() > 0 && now_.force[i] != force_before_[i];
      const double kept = held ? std::max(0.0, -ended / begun) * (again ? 0.5 : 1) : 0;
      for (int c = 0, row = i; c < rows; ++c, row += n) dropped[row] = (1 - kept) * now_.force[row];
    }
  }
  if (dropped.size() == 0) return false;
  if (force_before_.size() == 0) force_before_ = now_.force, acceleration_before_ = now_.acceleration;
  now_.force -= dropped;
  mass_spread_->add(1, mass_spread_->factor.transpose() * dropped, now_.acceleration);
  return true;
}

/// A step that has failed leaves its beginning as it was.
void Stepper::restore_dropped() {
  if (force_before_.size() == 0) return;
  now_.force = force_before_, now_.acceleration = acceleration_before_;
  force_before_.resize(0);
}

/// Velocity and acceleration by the rule of the case. Where a point with friction is open, friction belongs to the impulse (true);
/// elsewhere sliding points slide on, and the rule alone is exact.
bool Stepper::apply_rule(const Impact& data) {
  const bool open = coulomb_ != nullptr && (force_before_.size() > 0 || lifted(last_->model->blocks, now_, contact_, next_.opening));
  if (open && impact_of_friction(data)) return true;
  velocity_free_ = next_.velocity;
  impact_.apply(data, next_.velocity, impulse_, impact_scratch_);
  if (!impact_.holds_acceleration()) return false;
  damp_impact(next_.velocity, next_.acceleration);
  impact_.hold(data, next_.acceleration, impact_scratch_);
  return false;
}

/// Whether an open point of a cone with friction is pressed at the end of the step.
bool Stepper::closes(const std::vector<Block>& blocks) const {
  return std::ranges::any_of(blocks, [&](const Block& block) {
    if (block.cone == nullptr || !(block.cone->friction() > 0)) return false;
    const int normal = block.first + block.batch.normal();
    for (int row = normal; row < normal + block.batch.points; ++row)
      if (pressed_[row] > 0 && now_.opening[row] > closed_gap_) return true;
    return false;
  });
}

/// The whole contact force is taken out of the velocity, and Coulomb's law at the level of velocities gives the impulse instead. False
/// where no impulse was found: the rule without friction then acts.
bool Stepper::impact_of_friction(const Impact& data) {
  const std::vector<Block>& blocks = last_->model->blocks;
  const bool closing = closes(blocks);
  Vector taken = Vector::Zero(contact_.size());
  for (const Block& block : blocks)
    if (block.cone != nullptr) taken.segment(block.first, block.rows()) = contact_.segment(block.first, block.rows());
  const Vector push = mass_spread_->factor.transpose() * taken;
  Vector velocity = next_.velocity;
  mass_spread_->add(data.velocity_weight, push, velocity);
  rates_.resize(contact_.size());
  row_rates(data, velocity, 0, contact_.size(), rates_);
  takes_part_ = pressed_;  // and those that are closed without a pressure: under a rigid base which ones is not unique
  for (const Block& block : blocks) {
    if (block.cone == nullptr) continue;
    const int normal = block.first + block.batch.normal();
    for (int row = normal; row < normal + block.batch.points; ++row)
      if (next_.opening[row] <= closed_gap_) takes_part_[row] = row_area_[row];
  }
  if (!coulomb_->solve(rates_, takes_part_)) return false;
  mass_spread_->add(1, coulomb_->z(), velocity);
  const Vector impulse = coulomb_->impulse(), rate = coulomb_->rate();

  // the force after the impact: what Coulomb's law asks for in half a step from now on
  Vector acceleration = next_.acceleration;
  mass_spread_->add(data.acceleration_weight, push, acceleration);
  velocity_free_ = next_.velocity;
  damp_impact(velocity, acceleration);
  const double still = 1e-9 * rates_.cwiseAbs().maxCoeff();
  for (Eigen::Index row = 0; row < takes_part_.size(); ++row)
    if (rate[row] > still) takes_part_[row] = 0;
  const double time = data.velocity_weight;
  row_rates(data, velocity + time * acceleration, 0, contact_.size(), rates_);
  if (!coulomb_->solve(rates_, takes_part_)) return false;
  mass_spread_->add(1 / time, coulomb_->z(), acceleration);
  next_.velocity = velocity, next_.acceleration = acceleration;
  for (const Block& block : blocks) {
    if (block.cone == nullptr) continue;
    contact_.segment(block.first, block.rows()) = coulomb_->impulse().segment(block.first, block.rows()) / time;
    if (!closing) continue;
    const int normal = block.first + block.batch.normal(), n = block.batch.points;
    impact_impulse_.segment(normal, n) = impulse.segment(normal, n) - time * contact_.segment(normal, n);
  }
  return true;
}

}  // namespace uplift
