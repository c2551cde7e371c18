#include <algorithm>
#include <cmath>

#include "uplift/contact/impact/projection.h"
#include "uplift/dynamics/contact_impacts.h"
#include "uplift/model/base_size.h"

// Contact is passive (docs/theory, section 5): the force at the beginning of a step does no work on a point that it no longer holds (18a),
// (18c), and the impulse of friction belongs to the projected normal impulse, not to the multiplier of the displacement solve (18b).
namespace uplift {
namespace {

constexpr double still_share = no_gap / closed_share;  // of closed_gap_: as far as contact is solved
constexpr double owed = 1e-9;                          // of the external work: less is no energy that contact has given

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
  return (one - other).cwiseAbs().maxCoeff() > still_share * closed_gap;
}

/// Work of the forces of a point's beginning and end in the step by the trapezoidal rule, (p_0 + p_1) dg/2.
struct PointWork {
  bool held;  // pressed at the end: its friction alone counts
  int rows;   // of its components, that count
  double begun = 0, ended = 0;
  double sum() const { return begun + ended; }
};

PointWork point_work(const Block& block, int first, const State& begin, const InterfaceSolution& end, double closed_gap) {
  const int n = block.batch.points;
  PointWork work{end.force[first + block.batch.normal()] < 0, block.batch.components};
  if (work.held) --work.rows;
  for (int c = 0, row = first; c < work.rows; ++c, row += n) {
    const double change = end.opening[row] - begin.opening[row];
    const double moved = std::abs(change) > still_share * closed_gap ? change : 0;  // a point that stays does no work by its round-off
    work.begun += 0.5 * begin.force[row] * moved, work.ended += 0.5 * end.force[row] * moved;
  }
  return work;
}

/// Energy that friction would give back in the step where points turn round [J].
double friction_given(const std::vector<Block>& blocks, const State& begin, const InterfaceSolution& end, double closed_gap) {
  double given = 0;
  for (const Block& block : blocks)
    if (block.cone != nullptr && block.cone->friction() > 0)
      for (int i = block.first; i < block.first + block.batch.points; ++i)
        given -= std::min(0.0, point_work(block, i, begin, end, closed_gap).sum());
  return given;
}

}  // namespace

/// With p_0 = 0 a point takes energy only; where its work is negative p_0 works on a motion that it does not resist. Such forces are taken
/// out of the beginning of the step, which is solved again: all of it at a point that has opened, as much of its friction as is too much at
/// one that has turned round. With friction wherever some point is open or the balance would show energy that friction has given; without
/// where the contact would give back more than it has ever taken. True when there are any.
bool ContactImpacts::drop_creating(const std::vector<Block>& blocks, State& begin, const InterfaceSolution& end, const Energies& energies,
                                   double of_pressures, double scale) {
  if (!passive_) return false;
  const double round_off = owed * scale, closed_gap = rows_.closed_gap;
  const bool slips =
      coulomb_ != nullptr && (dropped_.slip || (moves(begin.opening, end.opening, closed_gap) &&
                                                (lifted(blocks, begin, end.force, end.opening, closed_gap) ||
                                                 energies.residual + friction_given(blocks, begin, end, closed_gap) > round_off)));
  const bool owes = energies.impact + of_pressures < -round_off;
  if (!slips && !owes) return false;
  const double nothing = 1e-15 * scale;
  Vector& taken = friction_.taken;
  bool any = false;
  for (const Block& block : blocks) {
    if (block.cone == nullptr || !(block.cone->friction() > 0 ? slips : owes)) continue;
    const int n = block.batch.points;
    for (int i = block.first; i < block.first + n; ++i) {
      const PointWork work = point_work(block, i, begin, end, closed_gap);
      if (work.sum() >= -nothing || !(work.begun < 0)) continue;
      if (!any) taken.setZero(begin.force.size());
      any = true;
      dropped_.slip = dropped_.slip || block.cone->friction() > 0;
      bool again = false;
      for (int c = 0, row = i; dropped_.any && c < work.rows; ++c, row += n) again = again || begin.force[row] != dropped_.force[row];
      const double kept = work.held ? std::max(0.0, -work.ended / work.begun) * (again ? 0.5 : 1) : 0;
      for (int c = 0, row = i; c < work.rows; ++c, row += n) taken[row] = (1 - kept) * begin.force[row];
    }
  }
  if (!any) return false;
  if (!dropped_.any) dropped_.force = begin.force, dropped_.acceleration = begin.acceleration;
  dropped_.any = true;
  begin.force -= taken;
  friction_.push.noalias() = rows_.mass.factor.transpose() * taken;
  rows_.mass.add(1, friction_.push, begin.acceleration);
  return true;
}

void ContactImpacts::restore_dropped(State& begin) {
  if (!dropped_.any) return;
  begin.force = dropped_.force, begin.acceleration = dropped_.acceleration;
  dropped_.any = dropped_.slip = false;
}

/// Whether the impulse of friction is wanted: a point with friction is open before or after the step, and something moves in it or at its
/// end; or one without a gap that was let go in the step before, with a velocity or an acceleration of its own, is struck where it is.
bool ContactImpacts::wants_friction(const SolvedStep& step, const Impact& data) {
  if (coulomb_ == nullptr) return false;
  if (dropped_.slip) return true;
  const std::vector<Block>& blocks = step.blocks;
  const State &begin = step.begin, &end = step.end;
  const double closed_gap = rows_.closed_gap;
  if (!any_without_pressure(blocks, begin.force, end.force, [](int, bool) { return true; })) return false;
  const bool open = lifted(blocks, begin, end.force, end.opening, closed_gap);
  if (open && moves(begin.opening, end.opening, closed_gap)) return true;
  const auto goes_on = [&](const Vector& motion, const Vector* moved, double weight) {
    row_rates(data, motion, moved, 0, end.force.size(), friction_.rates);
    if (open) return weight * friction_.rates.cwiseAbs().maxCoeff() > still_share * closed_gap;
    return any_without_pressure(blocks, begin.force, end.force,
                                [&](int row, bool) { return weight * std::abs(friction_.rates[row]) > still_share * closed_gap; });
  };
  return goes_on(end.velocity, data.moved_velocity, data.step) || goes_on(end.acceleration, data.moved_acceleration, data.step * data.step);
}

/// The whole contact force is taken out of the velocity, and Coulomb's law at the level of velocities gives the impulse instead. False
/// where no impulse was found: the rule without friction then acts.
bool ContactImpacts::impact_of_friction(SolvedStep& step, const Impact& data) {
  const std::vector<Block>& blocks = step.blocks;
  const Spread* damped = step.factors.damped.get();
  State& end = step.end;
  FrictionScratch& now = friction_;
  take_forces(step);
  const Spread& spread = damped != nullptr ? *damped : rows_.mass;
  CoulombRates& impulses = damped != nullptr ? *step.factors.coulomb : *coulomb_;
  now.push.noalias() = spread.factor.transpose() * now.taken;
  now.velocity = end.velocity;
  spread.add(data.velocity_weight, now.push, now.velocity);
  row_rates(data, now.velocity, data.moved_velocity, 0, end.force.size(), now.rates);
  now.takes_part = rows_.pressed;  // and those that are closed without a pressure: under a rigid base which ones is not unique
  for (const Block& block : blocks) {
    if (block.cone == nullptr) continue;
    const int normal = block.first + block.batch.normal();
    for (int row = normal; row < normal + block.batch.points; ++row)
      if (end.opening[row] <= rows_.closed_gap) now.takes_part[row] = rows_.area[row];
  }
  if (!impulses.solve(now.rates, now.takes_part, still_share * rows_.closed_gap / data.step)) return false;
  spread.add(1, impulses.z(), now.velocity);
  now.impulse = impulses.impulse();
  now.change = now.impulse - data.velocity_weight * now.taken;

  // the force after the impact
  const double at_rest = 1e-9 * now.rates.cwiseAbs().maxCoeff();
  for (Index row = 0; row < now.takes_part.size(); ++row)
    if (impulses.rate()[row] > at_rest) now.takes_part[row] = 0;
  const bool soft = closing_ && damped != nullptr;
  now.after = end.acceleration;
  damp_impact(step, now.velocity, now.after);
  if (soft) soften(step, now.after);
  if (!obey_friction(step, soft ? *damped : rows_.mass, soft ? *step.factors.coulomb : *coulomb_, data, now.velocity, now.after))
    return false;
  end.velocity = now.velocity, end.acceleration = now.after;
  if (correction_.size() > 0) correction_ = now.change;
  if (!closing_) return true;
  now.velocity += step.begin.velocity;
  row_rates(data, now.velocity, data.moved_velocity, 0, end.force.size(), now.rates);
  if (rows_.motion.acts()) rows_.motion.add_velocity(step.begin.time, now.rates);
  step.energies.impact += step.friction;
  step.friction = friction_of_impulses(blocks, step.begin, end, 1 - scheme_.end_share(), now.impulse, now.rates);
  step.energies.impact -= step.friction;
  for (const Block& block : blocks) {
    if (block.cone == nullptr) continue;
    const int normal = block.first + block.batch.normal(), n = block.batch.points;
    transferred_.segment(normal, n) = now.impulse.segment(normal, n) - data.velocity_weight * end.force.segment(normal, n);
  }
  return true;
}

/// Forces by Coulomb's law: those for what half a step from now on would bring, in place of the present ones, which the acceleration
/// contains. False where none are found: the forces stay, and the acceleration is of no use.
bool ContactImpacts::obey_friction(SolvedStep& step, const Spread& spread, CoulombRates& law, const Impact& data, const Vector& velocity,
                                   Vector& acceleration) {
  FrictionScratch& now = friction_;
  const double time = data.velocity_weight / data.acceleration_weight;
  take_forces(step);
  now.push.noalias() = spread.factor.transpose() * now.taken;
  spread.add(data.acceleration_weight, now.push, acceleration);
  now.soon = velocity + time * acceleration;
  row_rates(data, now.soon, data.moved_velocity, 0, step.end.force.size(), now.rates);
  if (data.moved_acceleration != nullptr) now.rates += time * *data.moved_acceleration;
  if (!law.solve(now.rates, now.takes_part, still_share * rows_.closed_gap / data.step)) return false;
  spread.add(1 / time, law.z(), acceleration);
  for (const Block& block : step.blocks)
    if (block.cone != nullptr)
      step.end.force.segment(block.first, block.rows()) = law.impulse().segment(block.first, block.rows()) / data.velocity_weight;
  return true;
}

/// The present forces of cones, those of laws zero, as the forces that are to be taken out.
void ContactImpacts::take_forces(const SolvedStep& step) {
  friction_.taken.setZero(step.end.force.size());
  for (const Block& block : step.blocks)
    if (block.cone != nullptr) friction_.taken.segment(block.first, block.rows()) = step.end.force.segment(block.first, block.rows());
}

}  // namespace uplift
