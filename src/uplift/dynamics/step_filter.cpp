#include <algorithm>

#include "uplift/dynamics/step_level.h"
#include "uplift/math/small.h"

// The filters of the scheme of filtered energy decay (docs/theory, section 3): d <- a d + (1 - a) (increment of the step) for displacement,
// velocity and the openings of the joints.
namespace uplift {

/// Filtered increments belong to a step; in a shorter one they count less, in a longer one they start from what there is. What they store
/// never grows by it.
double Stepper::filter_shrink(const Level& level) const {
  const double before = now_.filter.step;
  return before > level.step ? level.step / before : 1;
}

/// Takes over what a stage before remembers, or starts from nothing.
void Stepper::begin_filters() {
  FilterMemory& memory = now_.filter;
  const Eigen::Index n = bulk_.unknowns, rows = b_.rows();
  if (!(memory.step > 0) || memory.displacement.size() != n || memory.opening.size() != rows) {
    memory.step = options_.step;
    memory.displacement.setZero(n);
    memory.velocity.setZero(n);
    memory.opening.setZero(rows);
    memory.coefficient.setZero(rows);
    memory.tangent.setZero(rows);
    if (joint_filter_ != nullptr) joint_filter_->look(now_, memory.tangent);
  }
  if (joint_filter_ != nullptr) joint_filter_->take_over(now_);
  filtered_stiff_.setZero(n);
  filtered_momentum_.setZero(n);
  products(memory.displacement, memory.velocity, filtered_stiff_, filtered_momentum_);
  if (bulk_.geometric != nullptr) filtered_stiff_ -= *bulk_.geometric * memory.displacement;
}

/// Moves the filters over the step that was just solved and books what they store and dissipate: with d before the step,
///     dissipation b (1 + a)/2 (|du - d_u|^2_K + |dv - d_v|^2_M),      storage b/(2 (1 - a)) (|d_u|^2_K + |d_v|^2_M)
/// work_ and work2_ receive K d_u and M d_v after it.
void Stepper::advance_filters(const Level& level) {
  const Eigen::Index n = bulk_.unknowns;
  const double a = options_.scheme.pole, b = options_.scheme.gain, shrink = filter_shrink(level), keep = 1 - a;
  const bool unfiltered = bulk_.geometric != nullptr;
  if (unfiltered) work_.noalias() = *bulk_.geometric * increment_;
  const double *du = increment_.data(), *v0 = now_.velocity.data(), *v1 = next_.velocity.data();
  const double *k0 = stiff_now_.data(), *k1 = stiff_next_.data(), *m0 = momentum_now_.data(), *m1 = momentum_next_.data();
  const double *d_u = now_.filter.displacement.data(), *d_v = now_.filter.velocity.data();
  const double *k_d = filtered_stiff_.data(), *m_d = filtered_momentum_.data();
  double *d_u1 = next_.filter.displacement.data(), *d_v1 = next_.filter.velocity.data(), *k_d1 = work_.data(), *m_d1 = work2_.data();
  double lost = 0, stored = 0;
  small::with_size(n, [=, &lost, &stored](auto count) {
    double loss = 0, after = 0;
#pragma omp simd reduction(+ : loss, after)
    for (Eigen::Index i = 0; i < count; ++i) {
      const double dv = v1[i] - v0[i], dk = k1[i] - k0[i] - (unfiltered ? k_d1[i] : 0), dm = m1[i] - m0[i];
      const double u_lag = shrink * d_u[i], v_lag = shrink * d_v[i], k_lag = shrink * k_d[i], m_lag = shrink * m_d[i];
      loss += (du[i] - u_lag) * (dk - k_lag) + (dv - v_lag) * (dm - m_lag);
      d_u1[i] = a * u_lag + keep * du[i];
      d_v1[i] = a * v_lag + keep * dv;
      k_d1[i] = a * k_lag + keep * dk;
      m_d1[i] = a * m_lag + keep * dm;
      after += d_u1[i] * k_d1[i] + d_v1[i] * m_d1[i];
    }
    lost = loss, stored = after;
  });
  const double storage = b / (2 * (1 - a));
  energies_.algorithmic += 0.5 * b * (1 + a) * lost;
  if (shrink < 1) energies_.algorithmic += storage * (1 - shrink * shrink) * (small::dot(n, d_u, k_d) + small::dot(n, d_v, m_d));
  energies_.filter = storage * stored;
  next_.filter.step = level.step;
  if (joint_filter_ == nullptr) return;
  joint_filter_->end(*last_, *solution_, now_, next_, level.solver->filter());
  energies_.algorithmic += joint_filter_->dissipated();
  energies_.filter += joint_filter_->storage();
}

}  // namespace uplift
