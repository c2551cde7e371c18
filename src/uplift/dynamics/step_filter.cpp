#include <algorithm>

#include "uplift/dynamics/step.h"
#include "uplift/math/small.h"

// The filters of the scheme of filtered energy decay (docs/theory, section 3): d <- a d + (1 - a) (increment of the step) for displacement,
// velocity and the openings of the joints.
namespace uplift {

/// Takes over what a stage before remembers, or starts from nothing.
void Stepper::begin_filters() {
  FilterMemory& memory = now_.filter;
  const Eigen::Index n = stage_.bulk.unknowns, rows = stage_.b.rows();
  const double a = options_.scheme.pole, b = options_.scheme.gain;
  filter_loss_ = 0.5 * b * (1 + a), filter_store_ = b / (2 * (1 - a));
  if (!(memory.step > 0) || memory.displacement.size() != n || memory.opening.size() != rows) {
    memory.gain = b;
    memory.step = options_.step;
    memory.stored = 0;
    memory.displacement.setZero(n);
    memory.velocity.setZero(n);
    memory.opening.setZero(rows);
    memory.coefficient.setZero(rows);
    if (joint_filter_ != nullptr) joint_filter_->begin_anew(now_, memory);
  }
  if (joint_filter_ != nullptr) joint_filter_->take_over(now_);
  filtered_stiff_.setZero(n);
  filtered_momentum_.setZero(n);
  products(memory.displacement, memory.velocity, filtered_stiff_, filtered_momentum_);
  if (stage_.bulk.geometric != nullptr) filtered_stiff_ -= *stage_.bulk.geometric * memory.displacement;
}

/// Filtered increments belong to a step: in a shorter one they count less, in a longer one they start from what there is. What they store
/// never grows by it, and what is left out counts as dissipated.
void Stepper::shorten_filters(double step) {
  FilterMemory& memory = now_.filter;
  const double shrink = step / memory.step;
  const double left_out =
      (1 - shrink * shrink) * filter_store_ * (memory.displacement.dot(filtered_stiff_) + memory.velocity.dot(filtered_momentum_));
  energies_.algorithmic += left_out, energies_.filter -= left_out;
  for (Vector* each : {&memory.displacement, &memory.velocity, &filtered_stiff_, &filtered_momentum_}) *each *= shrink;
  if (joint_filter_ != nullptr) joint_filter_->shorten(shrink);
  memory.step = step;
}

/// Moves the filters over the step that was just solved and books what they store and dissipate: with d before the step,
///     dissipation b (1 + a)/2 (|du - d_u|^2_K + |dv - d_v|^2_M),      storage b/(2 (1 - a)) (|d_u|^2_K + |d_v|^2_M)
/// The geometric stiffness is not filtered.
void Stepper::advance_filters(const StepSize& size) {
  const Eigen::Index n = stage_.bulk.unknowns;
  const double a = options_.scheme.pole, keep = 1 - a;
  const Vector* stiff_before = &stiff_now_;
  if (stage_.bulk.geometric != nullptr) {
    work_ = stiff_now_ + *stage_.bulk.geometric * increment_;
    stiff_before = &work_;
  }
  const double *du = increment_.data(), *v0 = now_.velocity.data(), *v1 = next_.velocity.data();
  const double *k0 = stiff_before->data(), *k1 = stiff_next_.data(), *m0 = momentum_now_.data(), *m1 = momentum_next_.data();
  const double *d_u = now_.filter.displacement.data(), *d_v = now_.filter.velocity.data();
  double *d_u1 = next_.filter.displacement.data(), *d_v1 = next_.filter.velocity.data();
  double *k_d = filtered_stiff_.data(), *m_d = filtered_momentum_.data();  // K d_u, M d_v
  double lost = 0, stored = 0;
  small::with_size(n, [=, &lost, &stored](auto count) {
    double loss = 0, after = 0;
#pragma omp simd reduction(+ : loss, after)
    for (Eigen::Index i = 0; i < count; ++i) {
      const double dv = v1[i] - v0[i], dk = k1[i] - k0[i], dm = m1[i] - m0[i];
      const double u = a * d_u[i] + keep * du[i], v = a * d_v[i] + keep * dv, ku = a * k_d[i] + keep * dk, mv = a * m_d[i] + keep * dm;
      loss += (du[i] - d_u[i]) * (dk - k_d[i]) + (dv - d_v[i]) * (dm - m_d[i]);
      after += u * ku + v * mv;
      d_u1[i] = u, d_v1[i] = v, k_d[i] = ku, m_d[i] = mv;
    }
    lost = loss, stored = after;
  });
  energies_.algorithmic += filter_loss_ * lost;
  energies_.filter = filter_store_ * stored;
  next_.filter.step = size.step;
  if (joint_filter_ == nullptr) return;
  joint_filter_->end(*last_, *solution_, now_, next_, size.solver->filter());
  energies_.algorithmic += joint_filter_->dissipated();
  energies_.filter += joint_filter_->storage();
}

}  // namespace uplift
