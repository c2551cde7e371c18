#include <algorithm>
#include <cmath>

#include "uplift/dynamics/step.h"
#include "uplift/math/small.h"

namespace uplift {

/// Adds the step that was just solved to the energies.
void Stepper::book_energies(const StepSize& size) {
  const Eigen::Index n = stage_.bulk.unknowns;
  const double *du = increment_.data(), *f0 = force_now_.data(), *f1 = force_next_.data();
  const double *u = next_.displacement.data(), *ku = stiff_end().data(), *v = next_.velocity.data(), *mv = momentum_end().data();
  double external = 0, strain = 0, kinetic = 0;
  small::with_size(n, [=, &external, &strain, &kinetic](auto count) {
    double sums[3] = {};
#pragma omp simd reduction(+ : sums)
    for (Eigen::Index i = 0; i < count; ++i) {
      sums[0] += (f0[i] + f1[i]) * du[i];
      sums[1] += u[i] * ku[i];
      sums[2] += v[i] * mv[i];
    }
    external = sums[0], strain = sums[1], kinetic = sums[2];
  });
  energies_.external += 0.5 * external;
  if (motion_.acts() && path_)
    energies_.external += next_.mean_force.dot(motion_.change());  // what moving supports put in through the interfaces
  if (!stage_.bulk.damping.zero()) {
    // work of the damping force, mean of both ends; average acceleration: C du/dt . du, with the velocity before an impact at the end
    if (path_ || (impacts_ != nullptr && options_.scheme.average_acceleration()))
      for (Eigen::Index i = 0; i < n; ++i) right_[i] = du[i] / size.step;
    else
      for (Eigen::Index i = 0; i < n; ++i) right_[i] = 0.5 * (now_.velocity[i] + next_.velocity[i]);
    stage_.bulk.damping.multiply(right_, work_);
    energies_.damping += small::dot(n, work_.data(), du);
  }
  if (impacts_ != nullptr) energies_.impact -= impacts_->lag_work(increment_);
  energies_.kinetic = 0.5 * kinetic;
  energies_.strain = 0.5 * strain;
  if (newton_ != nullptr) {
    energies_.strain += yielding_.energy(next_.displacement, next_.time, plastic_next_);
    energies_.plastic += yielding_.dissipated(now_.displacement, now_.time, plastic_now_, next_.displacement, next_.time, plastic_next_);
    energies_.external += yielding_.support_work(now_.time, plastic_now_, next_.time, plastic_next_);
  }
  if (stage_.b.rows() > 0 && solution_->fused)  // memory and what was dissipated stay
    interface_energy_.stored = solution_->stored;
  else
    interface_energy_.update(last_->model->blocks, next_.opening, next_.history);
  energies_.stored = interface_energy_.stored;
  energies_.interface_dissipated = interface_energy_.dissipated + energies_.friction;
  if (filtered_) advance_filters(size);
  energies_.residual = energies_.sum() - origin_;
  largest_external_ = std::max(largest_external_, std::abs(energies_.external));
}

}  // namespace uplift
