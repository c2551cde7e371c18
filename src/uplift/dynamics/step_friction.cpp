#include <algorithm>
#include <cmath>

#include "uplift/contact/impact/projection.h"
#include "uplift/dynamics/step_level.h"
#include "uplift/model/base_size.h"

// Contact is passive (docs/theory, section 5): the force at the beginning of a step does no work on a point that it no longer holds (18a),
// (18c), and the impulse of friction belongs to the projected normal impulse, not to the multiplier of the displacement solve (18b).
namespace uplift {
namespace {

constexpr double still = no_gap / closed_share;  // of closed_gap_: as far as contact is solved
constexpr double owed = 1e-9;                    // of the external work: less is no energy that contact has given

/// Whether a point with friction that bears no pressure before or after a step is `wanted`(row of its opening, at the end).
template <class Wanted>
bool any_without_pressure(const std::vector<Block>& blocks, const Vector& before, const Vector& after, const Wanted& wanted) {
  return std::ranges::any_of(blocks, [&](const Block& block) {
    if (block.cone == nullptr || !(block.cone->friction() > 0)) return false;
    const int normal = block.first + block.batch.normal();
    for (int row = normal; row < normal + block.batch.points; ++row)
      if ((!(before[row] < 0) && wanted(row, false)) || (!(after[row] < 0) && wanted(row, true))) return true;
    return false;
  });
}

/// Whether a point with friction is open before or after a step: without a pressure and with a gap. A point that stays closed without one
/// is not open: where there are more points than openings, others bear its share.
bool lifted(const std::vector<Block>& blocks, const State& before, const Vector& force, const Vector& opening, double closed_gap) {
  return any_without_pressure(blocks, before.force, force,
                              [&](int row, bool at_end) { return (at_end ? opening : before.opening)[row] > closed_gap; });
}

/// Work of friction in a step in which a gap closes, by the impulses P that act: sum of max(0, w_0 p_0 . dg + 1/2 P . (r_0 + r_1)) with the
/// rates r of the slip before and after; `rates` is their sum, w_0 the share of the force at the beginning. The multiplier of such a step
/// may be up to twice the impulse over the step.
double friction_of_impulses(const std::vector<Block>& blocks, const State& before, const State& after, double begin_share,
                            const Vector& impulse, const Vector& rates) {
  double work = 0;
  for (const Block& block : blocks) {
    if (block.cone == nullptr) continue;
    const int n = block.batch.points;
    for (int i = block.first; i < block.first + n; ++i) {
      double of_point = 0;
      for (int c = 0, row = i; c + 1 < block.batch.components; ++c, row += n)
        of_point += begin_share * before.force[row] * (after.opening[row] - before.opening[row]) + 0.5 * impulse[row] * rates[row];
      work += std::max(0.0, of_point);
    }
  }
  return work;
}

bool moves(const Vector& one, const Vector& other, double closed_gap) {
  return (one - other).cwiseAbs().maxCoeff() > still * closed_gap;
}

}  // namespace

void Stepper::prepare_friction(const std::vector<Block>& blocks) {
  coulomb_ = std::make_unique<CoulombRates>(blocks, mass_spread_->factor);
  for (Vector* rows :
       {&friction_.force, &friction_.dropped, &friction_.rates, &friction_.takes_part, &friction_.impulse, &friction_.change})
    rows->setZero(b_.rows());
  for (Vector* unknowns : {&friction_.acceleration, &friction_.velocity, &friction_.after, &friction_.soon})
    unknowns->setZero(bulk_.unknowns);
  friction_.push.setZero(mass_spread_->factor.cols());
}

/// Work of the forces of a point's beginning and end in the step by the trapezoidal rule, (p_0 + p_1) dg/2.
struct Stepper::PointWork {
  bool held;  // pressed at the end: its friction alone counts
  int rows;   // of its components, that count
  double begun = 0, ended = 0;
  double sum() const { return begun + ended; }
};

Stepper::PointWork Stepper::point_work(const Block& block, int first, const InterfaceSolution& end) const {
  const int n = block.batch.points;
  PointWork work{end.force[first + block.batch.normal()] < 0, block.batch.components};
  if (work.held) --work.rows;
  for (int c = 0, row = first; c < work.rows; ++c, row += n) {
    const double change = end.opening[row] - now_.opening[row];
    const double moved = std::abs(change) > still * closed_gap_ ? change : 0;  // a point that stays does no work by its round-off
    work.begun += 0.5 * now_.force[row] * moved, work.ended += 0.5 * end.force[row] * moved;
  }
  return work;
}

/// Energy that friction would give back in the step where points turn round [J].
double Stepper::friction_given(const std::vector<Block>& blocks, const InterfaceSolution& end) const {
  double given = 0;
  for (const Block& block : blocks)
    if (block.cone != nullptr && block.cone->friction() > 0)
      for (int i = block.first; i < block.first + block.batch.points; ++i) given -= std::min(0.0, point_work(block, i, end).sum());
  return given;
}

/// With p_0 = 0 a point takes energy only; where its work is negative p_0 works on a motion that it does not resist. Such forces are taken
/// out of the beginning of the step, which is solved again: all of it at a point that has opened, as much of its friction as is too much at
/// one that has turned round. With friction wherever some point is open or the balance would show energy that friction has given; without
/// where the contact would give back more than it has ever taken. True when there are any.
bool Stepper::drop_creating() {
  if (!options_.scheme.average_acceleration() || !impact_.holds_acceleration()) return false;
  const InterfaceSolution& end = *solution_;
  const std::vector<Block>& blocks = last_->model->blocks;
  const double scale = std::max(largest_external_, std::abs(initial_energy_)), round_off = owed * scale;
  const bool slips = coulomb_ != nullptr && (friction_.slips || (moves(now_.opening, end.opening, closed_gap_) &&
                                                                 (lifted(blocks, now_, end.force, end.opening, closed_gap_) ||
                                                                  energies_.residual + friction_given(blocks, end) > round_off)));
  const bool owes = impact_loss_ + contact_work(end.force, end.opening) < -round_off;
  if (!slips && !owes) return false;
  const double nothing = 1e-15 * scale;
  Vector& dropped = friction_.dropped;
  bool any = false;
  for (const Block& block : blocks) {
    if (block.cone == nullptr || !(block.cone->friction() > 0 ? slips : owes)) continue;
    const int n = block.batch.points;
    for (int i = block.first; i < block.first + n; ++i) {
      const PointWork work = point_work(block, i, end);
      if (work.sum() >= -nothing || !(work.begun < 0)) continue;
      if (!any) dropped.setZero(now_.force.size());
      any = true;
      friction_.slips = friction_.slips || block.cone->friction() > 0;
      bool again = false;
      for (int c = 0, row = i; friction_.reduced && c < work.rows; ++c, row += n) again = again || now_.force[row] != friction_.force[row];
      const double kept = work.held ? std::max(0.0, -work.ended / work.begun) * (again ? 0.5 : 1) : 0;
      for (int c = 0, row = i; c < work.rows; ++c, row += n) dropped[row] = (1 - kept) * now_.force[row];
    }
  }
  if (!any) return false;
  if (!friction_.reduced) friction_.force = now_.force, friction_.acceleration = now_.acceleration;
  friction_.reduced = true;
  now_.force -= dropped;
  friction_.push.noalias() = mass_spread_->factor.transpose() * dropped;
  mass_spread_->add(1, friction_.push, now_.acceleration);
  return true;
}

/// A step that has failed leaves its beginning as it was.
void Stepper::restore_dropped() {
  if (!friction_.reduced) return;
  now_.force = friction_.force, now_.acceleration = friction_.acceleration;
  friction_.reduced = friction_.slips = false;
}

/// Whether the impulse of friction is wanted: a point with friction is open before or after the step, and something moves in it or at its
/// end; or one without a gap that was let go in the step before, with a velocity or an acceleration of its own, is struck where it is.
bool Stepper::strikes(const Impact& data) {
  if (coulomb_ == nullptr) return false;
  const std::vector<Block>& blocks = last_->model->blocks;
  if (friction_.slips) return true;
  if (!any_without_pressure(blocks, now_.force, contact_, [](int, bool) { return true; })) return false;
  const bool open = lifted(blocks, now_, contact_, next_.opening, closed_gap_);
  if (open && moves(now_.opening, next_.opening, closed_gap_)) return true;
  const auto goes_on = [&](const Vector& motion, const Vector* moved, double weight) {
    row_rates(data, motion, moved, 0, contact_.size(), friction_.rates);
    if (open) return weight * friction_.rates.cwiseAbs().maxCoeff() > still * closed_gap_;
    return any_without_pressure(blocks, now_.force, contact_,
                                [&](int row, bool) { return weight * std::abs(friction_.rates[row]) > still * closed_gap_; });
  };
  return goes_on(next_.velocity, data.moved_velocity, data.step) ||
         goes_on(next_.acceleration, data.moved_acceleration, data.step * data.step);
}

/// Velocity and acceleration by the rule of the case: impulses spread with the damping force that they change. Where a point with friction
/// is open, friction belongs to the impulse (true); elsewhere sliding points slide on, and the rule alone is exact.
bool Stepper::apply_rule(const Level& level, Impact& data) {
  if (strikes(data) && impact_of_friction(level, data)) return true;
  if (level.impact != nullptr) data.mass = level.impact.get();
  impact_.apply(data, next_.velocity, impulse_, impact_scratch_);
  if (!impact_.holds_acceleration()) return false;
  damp_impact(level, next_.velocity, next_.acceleration);
  if (level.impact != nullptr && closing_)
    soften(level, next_.acceleration);
  else
    data.mass = mass_spread_.get();
  impact_.hold(data, next_.acceleration, impact_scratch_);
  return false;
}

/// The whole contact force is taken out of the velocity, and Coulomb's law at the level of velocities gives the impulse instead. False
/// where no impulse was found: the rule without friction then acts.
bool Stepper::impact_of_friction(const Level& level, const Impact& data) {
  const std::vector<Block>& blocks = last_->model->blocks;
  FrictionOfImpacts& now = friction_;
  take_forces();
  const Spread& spread = level.impact != nullptr ? *level.impact : *mass_spread_;
  CoulombRates& impulses = level.impact != nullptr ? *level.coulomb : *coulomb_;
  now.push.noalias() = spread.factor.transpose() * now.dropped;
  now.velocity = next_.velocity;
  spread.add(data.velocity_weight, now.push, now.velocity);
  row_rates(data, now.velocity, data.moved_velocity, 0, contact_.size(), now.rates);
  now.takes_part = pressed_;  // and those that are closed without a pressure: under a rigid base which ones is not unique
  for (const Block& block : blocks) {
    if (block.cone == nullptr) continue;
    const int normal = block.first + block.batch.normal();
    for (int row = normal; row < normal + block.batch.points; ++row)
      if (next_.opening[row] <= closed_gap_) now.takes_part[row] = row_area_[row];
  }
  if (!impulses.solve(now.rates, now.takes_part, still * closed_gap_ / level.step)) return false;
  spread.add(1, impulses.z(), now.velocity);
  now.impulse = impulses.impulse();
  now.change = now.impulse - data.velocity_weight * now.dropped;

  // the force after the impact
  const double at_rest = 1e-9 * now.rates.cwiseAbs().maxCoeff();
  for (Index row = 0; row < now.takes_part.size(); ++row)
    if (impulses.rate()[row] > at_rest) now.takes_part[row] = 0;
  const bool soft = closing_ && level.impact != nullptr;
  now.after = next_.acceleration;
  damp_impact(level, now.velocity, now.after);
  if (soft) soften(level, now.after);
  if (!obey_friction(soft ? *level.impact : *mass_spread_, soft ? *level.coulomb : *coulomb_, data, now.velocity, now.after)) return false;
  next_.velocity = now.velocity, next_.acceleration = now.after, impulse_ = now.change;
  if (!closing_) return true;
  now.velocity += now_.velocity;
  row_rates(data, now.velocity, data.moved_velocity, 0, contact_.size(), now.rates);
  if (gap_moves_)
    for (const PrescribedMotion& motion : model_.motions) now.rates += motion.opening * motion.function->rate(now_.time);
  impact_loss_ += friction_step_;
  friction_step_ = friction_of_impulses(blocks, now_, next_, 1 - end_share(), now.impulse, now.rates);
  impact_loss_ -= friction_step_;
  for (const Block& block : blocks) {
    if (block.cone == nullptr) continue;
    const int normal = block.first + block.batch.normal(), n = block.batch.points;
    impact_impulse_.segment(normal, n) = now.impulse.segment(normal, n) - data.velocity_weight * contact_.segment(normal, n);
  }
  return true;
}

/// Forces by Coulomb's law: those for what half a step from now on would bring, in place of the present ones, which the acceleration
/// contains. False where none are found: the forces stay, and the acceleration is of no use.
bool Stepper::obey_friction(const Spread& spread, CoulombRates& law, const Impact& data, const Vector& velocity, Vector& acceleration) {
  FrictionOfImpacts& now = friction_;
  const double time = data.velocity_weight / data.acceleration_weight;
  take_forces();
  now.push.noalias() = spread.factor.transpose() * now.dropped;
  spread.add(data.acceleration_weight, now.push, acceleration);
  now.soon = velocity + time * acceleration;
  row_rates(data, now.soon, data.moved_velocity, 0, contact_.size(), now.rates);
  if (data.moved_acceleration != nullptr) now.rates += time * *data.moved_acceleration;
  if (!law.solve(now.rates, now.takes_part, still * closed_gap_ / data.step)) return false;
  spread.add(1 / time, law.z(), acceleration);
  for (const Block& block : last_->model->blocks)
    if (block.cone != nullptr)
      contact_.segment(block.first, block.rows()) = law.impulse().segment(block.first, block.rows()) / data.velocity_weight;
  return true;
}

/// The present forces of cones, those of laws zero, as the forces that are to be taken out.
void Stepper::take_forces() {
  friction_.dropped.setZero(contact_.size());
  for (const Block& block : last_->model->blocks)
    if (block.cone != nullptr) friction_.dropped.segment(block.first, block.rows()) = contact_.segment(block.first, block.rows());
}

}  // namespace uplift
