#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/contact/impact/projection.h"
#include "uplift/dynamics/step_level.h"
#include "uplift/math/small.h"

namespace uplift {

/// How impulses spread through the mass matrix, and work space; nothing when it cannot be factorised.
void Stepper::prepare_impacts() {
  if (!accelerator().why().empty()) return;
  mass_spread_ = std::make_unique<Spread>(accelerator().spread(b_));
  row_area_.resize(b_.rows());
  pressed_.setZero(b_.rows());
  tangents_.reserve(static_cast<std::size_t>(b_.rows()));
  Eigen::Index row = 0;
  for (const Interface& interface : model_.interfaces)
    for (int i = 0; i < interface.rows(); ++i) row_area_[row++] = interface.area[i % interface.batch.points];
  if (bulk_.small) dense_b_ = Matrix(b_);
  const std::vector<Block> blocks = blocks_of(model_, behaviours_).blocks;
  if (impacts_ && impact_.holds_acceleration() && any_friction(blocks)) prepare_friction(blocks);
}

/// The rows that take part in an impact: normal rows of constraints that are pressed (or, where there is no constraint, those of stiff
/// laws), and the tangential rows of points that stick. False when nothing is pressed.
bool Stepper::select_pressed(const std::vector<Block>& blocks, const Vector& forces) {
  const double nothing = 1e-12 * forces.cwiseAbs().maxCoeff();
  const bool constrained = std::ranges::any_of(blocks, [](const Block& block) { return block.cone != nullptr; });
  bool any_pressed = false;
  pressed_.setZero(forces.size());
  tangents_.clear();
  for (const Block& block : blocks) {
    if (constrained && block.cone == nullptr) continue;  // a law beside constraints gives way
    const int n = block.batch.points, normal = block.first + block.batch.normal();
    const double *force = forces.data() + normal, *area = row_area_.data() + normal;
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
      for (int c = 0; c < block.batch.components - 1; ++c) tangential = std::hypot(tangential, forces[block.first + c * n + i]);
      if (!(tangential < friction * -force[i] * (1 - 1e-9))) continue;
      for (int c = 0; c < block.batch.components - 1; ++c) tangents_.push_back(block.first + c * n + i);
    }
  }
  return any_pressed;
}

/// What does not change from step to step; the caller swaps the sticking rows in and out.
Impact Stepper::impact_data(const Vector& force) const {
  Impact data;
  data.mass = mass_spread_.get();
  data.b = bulk_.small ? &dense_b_ : nullptr;
  data.sparse_b = &b_;
  data.pressed = &pressed_;
  data.force = &force;
  data.area = &row_area_;
  if (gap_moves_) data.moved_velocity = &moved_velocity_, data.moved_acceleration = &moved_acceleration_;
  return data;
}

/// The share w_1 of the force at the end of a step in the change of velocity; that of the force at its beginning is 1 - w_1. Half with
/// average acceleration.
double Stepper::end_share() const {
  const Scheme& scheme = options_.scheme;
  return scheme.gamma * (1 - scheme.alpha_f) / (1 - scheme.alpha_m);
}

/// Work that the pressures of constraints take from the motion in the step, (w_0 p_0 + w_1 p_1) dg. It is zero where a point stays closed;
/// where a gap closes it is the part of the impact's loss that the projection of the velocity does not see, where one opens a little is
/// given back. The sum with the projection does not depend on the step (docs/theory, section 5).
double Stepper::contact_work(const Vector& end_force, const Vector& end_opening) const {
  const double of_end = end_share(), of_begin = 1 - of_end;
  double work = 0;
  for (const Block& block : last_->model->blocks) {
    if (block.cone == nullptr) continue;
    const int normal = block.first + block.batch.normal();
    const double *force = now_.force.data() + normal, *next_force = end_force.data() + normal, *opening = now_.opening.data() + normal,
                 *next_opening = end_opening.data() + normal;
#pragma omp simd reduction(+ : work)
    for (int i = 0; i < block.batch.points; ++i) work += (of_begin * force[i] + of_end * next_force[i]) * (next_opening[i] - opening[i]);
  }
  return work;
}

/// Velocity, acceleration and contact force of a step are corrected by the rule of impact, for the points that are pressed at its end. The
/// force stays the one that the acceleration at the end contains.
void Stepper::apply_impact(Level& level) {
  impact_impulse_.setZero();
  impulse_.setZero();
  kick_next_.step = 0;
  impact_loss_ += contact_work(contact_, next_.opening);
  if (!select_pressed(last_->model->blocks, contact_)) return;
  Impact data = impact_data(contact_);
  data.dynamic = level.dynamic.get();
  std::swap(data.tangents, tangents_);
  data.step = level.step;
  data.velocity_weight = velocity_weight(level);
  data.acceleration_weight = (1 - options_.scheme.alpha_f) / (1 - options_.scheme.alpha_m);
  const double before = 0.5 * small::dot(next_.velocity.size(), next_.velocity.data(), momentum_end().data());
  velocity_free_ = next_.velocity;
  closing_ = gap_closes();
  const bool with_friction = apply_rule(level, data);
  std::swap(data.tangents, tangents_);
  bulk_.mass.multiply(next_.velocity, momentum_end());
  impact_loss_ += before - 0.5 * small::dot(next_.velocity.size(), next_.velocity.data(), momentum_end().data());
  if (gap_moves_) {  // what moving supports put in by the impulses
    const double work = impulse_.dot(moved_velocity_);
    impact_loss_ += work, energies_.external += work;
  }
  if (impact_.holds_acceleration() && !with_friction) separate_impulse(data);
  if (level.impact != nullptr) balance_damping(level, data, with_friction);
}

/// The force that balances the accelerations after the impact is that of the contact: it is reported, and the next step begins with it. In
/// a step in which a gap closes, the force of the displacement solve contains the momentum that the impact transfers, over the step: it
/// grows as 1/dt, and the rest is reported as an impulse [N s].
void Stepper::separate_impulse(const Impact& data) {
  constexpr double round_off = 1e-9;
  const ImpactScratch& scratch = impact_scratch_;
  if (!closing_ && !(scratch.push.squaredNorm() > round_off * round_off * scratch.y.squaredNorm())) return;
  read_forces(data, closing_ || gap_moves_);  // on a moving support the force of a held point works
  if (!closing_) return;
  for (const Block& block : last_->model->blocks) {
    if (block.cone == nullptr) continue;  // the force of a law follows from its opening
    const int normal = block.first + block.batch.normal();
    for (int row = normal; row < normal + block.batch.points; ++row)
      if (pressed_[row] > 0) impact_impulse_[row] = scratch.total[row] - data.velocity_weight * contact_[row];
  }
}

/// The contact forces that belong to the acceleration that was projected last. How friction distributes a force over redundant points is
/// not unique, its sum is: all forces keep their ratios.
void Stepper::read_forces(const Impact& data, bool with_friction) {
  for (const Block& block : last_->model->blocks) {
    if (block.cone == nullptr) continue;
    const int n = block.batch.points, normal = block.first + block.batch.normal();
    const auto smooth = impact_scratch_.impulse.segment(normal, n) / data.acceleration_weight;  // that of other rows is of no step
    if (block.cone->friction() > 0) {
      double before = 0, after = 0;
      for (int i = 0; i < n; ++i)
        if (pressed_[normal + i] > 0) before += contact_[normal + i], after += smooth[i];
      if (with_friction && before < 0) contact_.segment(block.first, block.rows()) *= after / before;
      continue;
    }
    for (int i = 0; i < n; ++i)
      if (pressed_[normal + i] > 0) contact_[normal + i] = smooth[i];
  }
}

/// Whether a row that is pressed at the end of the step was open at its beginning.
bool Stepper::gap_closes() const {
  const double *pressed = pressed_.data(), *opening = now_.opening.data(), gap = closed_gap_;
  int closing = 0;
#pragma omp simd reduction(+ : closing)
  for (Eigen::Index i = 0; i < pressed_.size(); ++i) closing += static_cast<int>(pressed[i] > 0) & static_cast<int>(opening[i] > gap);
  return closing > 0;
}

/// Where a gap closes, (M + w D) a' = f - K u - D v - B^T p: a mode that damping stops within a step stays at rest, where the trapezoidal
/// rule would turn it round and tear the contact open.
void Stepper::soften(const Level& level, Vector& acceleration) {
  bulk_.mass.multiply(acceleration, product_);
  level.impact_factor->solve(product_, acceleration, impact_work_);
}

/// Whether the kinetic energy of a change of velocity is none beside that of a velocity: translations and rotations have no norm in common.
bool Stepper::is_round_off(const Vector& change, const Vector& velocity) {
  constexpr double round_off = 1e-12;
  bulk_.mass.multiply(change, work_);
  const double changed = change.dot(work_);
  bulk_.mass.multiply(velocity, work_);
  return changed <= round_off * round_off * velocity.dot(work_);
}

/// The impulse by which an impact changes the damping force over half a step, w D (v' - v), acts at once. The state after it has the
/// acceleration and the contact force with all of D v' that the step resolves, (M + w D) (a'' - a') = -D (v' - v) - B^T (p'' - p'); the
/// next step begins with a' and p', which contain D v, and so takes the impulse back.
void Stepper::balance_damping(const Level& level, Impact& data, bool with_friction) {
  product_ = next_.velocity - velocity_free_;
  if (!closing_ && is_round_off(product_, next_.velocity)) return;
  Kick& kick = kick_next_;
  kick.step = level.step;
  kick.acceleration = next_.acceleration;
  kick.force = contact_;
  bulk_.damping.multiply(product_, work_);
  level.impact_factor->solve(work_, work2_, impact_work_);
  next_.acceleration -= work2_;
  data.mass = level.impact.get();
  if (with_friction) {
    if (!obey_friction(*level.impact, *level.coulomb, data, next_.velocity, next_.acceleration)) next_.acceleration = kick.acceleration;
  } else {
    impact_scratch_.taken = impact_scratch_.impulse / data.acceleration_weight;
    project_rate(data, next_.acceleration, data.moved_acceleration, data.acceleration_weight, Select::all, impact_scratch_);
    correct(data, 1, next_.acceleration, impact_scratch_);
    read_forces(data, true);
  }
  kick.acceleration -= next_.acceleration;
  kick.force -= contact_;
  for (const Block& block : last_->model->blocks) {
    if (block.cone == nullptr) continue;
    for (int row = block.first + block.batch.normal(), i = 0; i < block.batch.points; ++i, ++row)
      if (impact_impulse_[row] != 0) impact_impulse_[row] += data.velocity_weight * kick.force[row];
  }
}

/// The step after an impact takes back what damping did at once, as far as it is as long as the step of the impact. What its beginning then
/// lacks in equilibrium does work, which belongs to the impact.
void Stepper::begin_kick(const Level& level) {
  if (!(kick_.step > 0)) return;
  const double share = std::min(1.0, kick_.step / level.step);
  unkicked_.acceleration = now_.acceleration;
  unkicked_.force = now_.force;
  now_.acceleration += share * kick_.acceleration;
  now_.force += share * kick_.force;
  bulk_.mass.multiply(now_.acceleration, lag_);
  forces_at(now_, work_);
  lag_ -= work_;
}

void Stepper::undo_kick() {
  if (!(kick_.step > 0)) return;
  now_.acceleration = unkicked_.acceleration;
  now_.force = unkicked_.force;
}

/// With other schemes than the trapezoidal rule: what damping D does to the acceleration when an impact has changed the velocity,
/// (M + d/m D) a_D = -D dv with K_eff = K + d D + m M. Solved by K_eff, with the right-hand side -D dv first and then with K/m a_D, what
/// the first one leaves.
void Stepper::damp_impact(const Level& level, const Vector& velocity, Vector& acceleration) {
  if (bulk_.damping.zero() || level.impact != nullptr) return;
  const BulkFactor* factor = level.solver->factor() != nullptr ? level.solver->factor() : level.impact_factor.get();
  product_ = velocity - velocity_free_;
  if (is_round_off(product_, velocity)) return;
  bulk_.damping.multiply(product_, work_);
  factor->solve(work_, work2_, impact_work_);
  acceleration -= level.mass * work2_;
  bulk_.stiffness.multiply(work2_, work_);
  factor->solve(work_, work2_, impact_work_);
  acceleration -= level.mass * work2_;
}

}  // namespace uplift
