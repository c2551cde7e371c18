#include "uplift/dynamics/contact_impacts.h"

#include <algorithm>
#include <utility>

#include "uplift/contact/impact/projection.h"
#include "uplift/math/small.h"

namespace uplift {

ContactImpacts::ContactImpacts(const ImpactRule& rule, const Scheme& scheme, const Bulk& bulk, ContactRows rows,
                               const std::vector<Block>& blocks, Forces forces, LinearCounts& counts)
    : rule_(rule),
      scheme_(scheme),
      passive_(scheme.average_acceleration() && rule.holds_acceleration()),
      bulk_(bulk),
      rows_(std::move(rows)),
      forces_(std::move(forces)),
      work_(counts) {
  for (Vector* of_rows : {&transferred_, &friction_.rates}) of_rows->setZero(rows_.b.rows());
  if (rule.force_includes_impulse() || rows_.motion.acts()) correction_.setZero(rows_.b.rows());
  for (Vector* unknowns : {&lag_, &load_, &response_, &free_velocity_}) unknowns->setZero(bulk.unknowns);
  if (rule.holds_acceleration() && any_friction(blocks)) coulomb_ = std::make_unique<CoulombRates>(blocks, rows_.mass.factor);
}

void ContactImpacts::set_kick(const Kick& kick) {
  if (kick.step > 0) kick_ = kick;
}

void ContactImpacts::begin_step(State& begin, double step) {
  if (!(kick_.step > 0)) return;
  const double share = std::min(1.0, kick_.step / step);
  unkicked_.acceleration = begin.acceleration;
  unkicked_.force = begin.force;
  begin.acceleration += share * kick_.acceleration;
  begin.force += share * kick_.force;
  bulk_.mass.multiply(begin.acceleration, lag_);
  forces_(begin, load_);
  lag_ -= load_;
}

double ContactImpacts::lag_work(const Vector& increment) const {
  return kick_.step > 0 ? 0.5 * small::dot(increment.size(), lag_.data(), increment.data()) : 0;
}

void ContactImpacts::undo(State& begin) {
  restore_dropped(begin);
  if (!(kick_.step > 0)) return;
  begin.acceleration = unkicked_.acceleration;
  begin.force = unkicked_.force;
}

void ContactImpacts::accept() {
  std::swap(kick_, next_kick_);
  dropped_.any = dropped_.slip = false;
}

/// Work that the pressures of constraints take from the motion in the step, (w_0 p_0 + w_1 p_1) dg. It is zero where a point stays closed;
/// where a gap closes it is the part of the impact's loss that the projection of the velocity does not see, where one opens a little is
/// given back. The sum with the projection does not depend on the step (docs/theory, section 5).
double ContactImpacts::contact_work(const std::vector<Block>& blocks, const State& begin, const InterfaceSolution& end) const {
  const double of_end = scheme_.end_share(), of_begin = 1 - of_end;
  double work = 0;
  for (const Block& block : blocks) {
    if (block.cone == nullptr) continue;
    const int normal = block.first + block.batch.normal();
    const double *force = begin.force.data() + normal, *next_force = end.force.data() + normal, *opening = begin.opening.data() + normal,
                 *next_opening = end.opening.data() + normal;
#pragma omp simd reduction(+ : work)
    for (int i = 0; i < block.batch.points; ++i) work += (of_begin * force[i] + of_end * next_force[i]) * (next_opening[i] - opening[i]);
  }
  return work;
}

void ContactImpacts::apply(SolvedStep& step) {
  const double taken = step.energies.impact;
  strike(step);
  // pressure and friction act together: what one gives while the other takes more is no energy that contact has given
  const double given = std::max(0.0, std::min({taken - step.energies.impact, -step.energies.impact, step.friction}));
  step.friction -= given, step.energies.impact += given;
  small::copy(step.end.force.size(), step.end.force.data(), step.end.mean_force.data());
  if (rule_.force_includes_impulse()) step.end.mean_force += correction_ / step.factors.step;
}

/// Velocity, acceleration and contact force of a step are corrected by the rule of impact, for the points that are pressed at its end. The
/// force stays the one that the acceleration at the end contains.
inline void ContactImpacts::strike(SolvedStep& step) {
  State& end = step.end;
  const auto kinetic = [&] { return 0.5 * small::dot(end.velocity.size(), end.velocity.data(), step.momentum.data()); };
  next_kick_.step = 0;
  closing_ = false;
  if (correction_.size() > 0) correction_.setZero();
  step.energies.impact += step.contact_work;
  if (!rows_.select_pressed(step.blocks, end.force)) return;
  Impact data = rows_.impact(end.force);
  data.dynamic = step.factors.dynamic.get();
  data.step = step.factors.step;
  data.velocity_weight = scheme_.velocity_weight(data.step);
  data.acceleration_weight = (1 - scheme_.alpha_f) / (1 - scheme_.alpha_m);
  const double before = kinetic();
  std::copy_n(end.velocity.data(), end.velocity.size(), free_velocity_.data());
  closing_ = gap_closes(step.begin);
  if (closing_) transferred_.setZero();
  const bool with_friction = apply_rule(step, data);
  bulk_.mass.multiply(end.velocity, step.momentum);
  step.energies.impact += before - kinetic();
  if (rows_.motion.acts()) {  // what moving supports put in by the impulses
    const double work = correction_.dot(*rows_.motion.velocity());
    step.energies.impact += work, step.energies.external += work;
  }
  if (rule_.holds_acceleration() && !with_friction) separate_impulse(step, data);
  if (step.factors.damped != nullptr) balance_damping(step, data, with_friction);
}

/// Whether a row that is pressed at the end of the step was open at its beginning.
inline bool ContactImpacts::gap_closes(const State& begin) const {
  const double *pressed = rows_.pressed.data(), *opening = begin.opening.data(), gap = rows_.closed_gap;
  LaneMask closing(false);
  for_lanes(rows_.pressed.size(), [&](const auto& at) { closing = closing || (at(pressed) > Lanes(0) && at(opening) > gap); });
  return any(closing);
}

/// Velocity and acceleration by the rule of the case: impulses spread with the damping force that they change. Where a point with friction
/// is open, friction belongs to the impulse (true); elsewhere sliding points slide on, and the rule alone is exact.
inline bool ContactImpacts::apply_rule(SolvedStep& step, Impact& data) {
  if (wants_friction(step, data) && impact_of_friction(step, data)) return true;
  const Spread* damped = step.factors.damped.get();
  if (damped != nullptr) data.mass = damped;
  rule_.apply(data, step.end.velocity, correction_, scratch_);
  if (!rule_.holds_acceleration()) return false;
  damp_impact(step, step.end.velocity, step.end.acceleration);
  if (damped != nullptr && closing_)
    soften(step, step.end.acceleration);
  else
    data.mass = &rows_.mass;
  rule_.hold(data, step.end.acceleration, scratch_);
  return false;
}

/// Where a gap closes, (M + w D) a' = f - K u - D v - B^T p: a mode that damping stops within a step stays at rest, where the trapezoidal
/// rule would turn it round and tear the contact open.
void ContactImpacts::soften(const SolvedStep& step, Vector& acceleration) {
  bulk_.mass.multiply(acceleration, load_);
  step.factors.factor->solve(load_, acceleration, work_);
}

/// Whether the kinetic energy of a change of velocity is none beside that of a velocity: translations and rotations have no norm in common.
bool ContactImpacts::is_round_off(const Vector& change, const Vector& velocity) {
  constexpr double round_off = 1e-12;
  bulk_.mass.multiply(change, load_);
  const double changed = change.dot(load_);
  bulk_.mass.multiply(velocity, load_);
  return changed <= round_off * round_off * velocity.dot(load_);
}

/// With other schemes than the trapezoidal rule: what damping D does to the acceleration when an impact has changed the velocity,
/// (M + d/m D) a_D = -D dv with K_eff = K + d D + m M. Solved by K_eff, with the right-hand side -D dv first and then with K/m a_D, what
/// the first one leaves.
void ContactImpacts::damp_impact(const SolvedStep& step, const Vector& velocity, Vector& acceleration) {
  if (bulk_.damping.zero() || step.factors.damped != nullptr) return;
  change_ = velocity - free_velocity_;
  if (is_round_off(change_, velocity)) return;
  bulk_.damping.multiply(change_, load_);
  step.factors.effective->solve(load_, response_, work_);
  acceleration -= step.factors.mass * response_;
  bulk_.stiffness.multiply(response_, load_);
  step.factors.effective->solve(load_, response_, work_);
  acceleration -= step.factors.mass * response_;
}

/// The force that balances the accelerations after the impact is that of the contact: it is reported, and the next step begins with it. In
/// a step in which a gap closes, the force of the displacement solve contains the momentum that the impact transfers, over the step: it
/// grows as 1/dt, and the rest is reported as an impulse [N s].
inline void ContactImpacts::separate_impulse(SolvedStep& step, const Impact& data) {
  constexpr double round_off = 1e-9;
  const auto square = [](const Vector& v) { return small::sum_of_squares(v.size(), v.data()); };
  if (!closing_ && !(square(scratch_.push) > round_off * round_off * square(scratch_.y))) return;
  read_forces(step, data, closing_ || rows_.motion.acts());  // on a moving support the force of a held point works
  if (!closing_) return;
  for (const Block& block : step.blocks) {
    if (block.cone == nullptr) continue;  // the force of a law follows from its opening
    const int normal = block.first + block.batch.normal();
    for (int row = normal; row < normal + block.batch.points; ++row)
      if (rows_.pressed[row] > 0) transferred_[row] = scratch_.total[row] - data.velocity_weight * step.end.force[row];
  }
}

/// The contact forces that belong to the acceleration that was projected last. How friction distributes a force over redundant points is
/// not unique, its sum is: all forces keep their ratios.
void ContactImpacts::read_forces(SolvedStep& step, const Impact& data, bool with_friction) {
  Vector& contact = step.end.force;
  for (const Block& block : step.blocks) {
    if (block.cone == nullptr) continue;
    const int n = block.batch.points, normal = block.first + block.batch.normal();
    const auto smooth = scratch_.impulse.segment(normal, n) / data.acceleration_weight;  // that of other rows is of no step
    if (block.cone->friction() > 0) {
      double before = 0, after = 0;
      for (int i = 0; i < n; ++i)
        if (rows_.pressed[normal + i] > 0) before += contact[normal + i], after += smooth[i];
      if (with_friction && before < 0) contact.segment(block.first, block.rows()) *= after / before;
      continue;
    }
    for (int i = 0; i < n; ++i)
      if (rows_.pressed[normal + i] > 0) contact[normal + i] = smooth[i];
  }
}

/// The impulse by which an impact changes the damping force over half a step, w D (v' - v), acts at once. The state after it has the
/// acceleration and the contact force with all of D v' that the step resolves, (M + w D) (a'' - a') = -D (v' - v) - B^T (p'' - p'); the
/// next step begins with a' and p', which contain D v, and so takes the impulse back.
void ContactImpacts::balance_damping(SolvedStep& step, Impact& data, bool with_friction) {
  State& end = step.end;
  change_ = end.velocity - free_velocity_;
  if (!closing_ && is_round_off(change_, end.velocity)) return;
  Kick& kick = next_kick_;
  kick.step = step.factors.step;
  kick.acceleration = end.acceleration;
  kick.force = end.force;
  bulk_.damping.multiply(change_, load_);
  step.factors.factor->solve(load_, response_, work_);
  end.acceleration -= response_;
  data.mass = step.factors.damped.get();
  if (with_friction) {
    if (!obey_friction(step, *data.mass, *step.factors.coulomb, data, end.velocity, end.acceleration)) end.acceleration = kick.acceleration;
  } else {
    scratch_.taken = scratch_.impulse / data.acceleration_weight;
    project_rate(data, end.acceleration, data.moved_acceleration, data.acceleration_weight, Select::all, scratch_);
    correct(data, 1, end.acceleration, scratch_);
    read_forces(step, data, true);
  }
  kick.acceleration -= end.acceleration;
  kick.force -= end.force;
  for (const Block& block : step.blocks) {
    if (block.cone == nullptr) continue;
    for (int row = block.first + block.batch.normal(), i = 0; i < block.batch.points; ++i, ++row)
      if (transferred_[row] != 0) transferred_[row] += data.velocity_weight * kick.force[row];
  }
}

}  // namespace uplift
