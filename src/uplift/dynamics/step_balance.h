#pragma once
#include "uplift/model/model.h"

namespace uplift {

/// The motion and the interface forces that the scheme balanced in its last step, M a + C v + K u + B^T p = f. Forces that are derived from
/// them are in equilibrium with the masses and the joint to round-off; end-of-step values would not be (docs/theory, section 13).
///
/// Average acceleration with path-averaged tractions: the means over the step, u = (u0 + u1)/2, v = (u1 - u0)/dt, a = (v1 - v0)/dt,
/// f = (f0 + f1)/2 and the mean joint force. Other schemes: their own weights, (1 - alpha_f) of the end for u, v, f and p, (1 - alpha_m)
/// for a.
class StepBalance {
 public:
  /// A state at rest: of the loads only the constant ones act and the prescribed motions, both by the state's load factor. `still` (free
  /// unknowns, zero) must stay alive.
  static StepBalance at_rest(const State& state, const Vector& still) {
    StepBalance made{state, state, still, still, 0, 0};
    made.rests_ = true;
    return made;
  }
  /// One state of a dynamic stage, for example before the first step; `acceleration` (free unknowns) must stay alive.
  static StepBalance of_state(const State& state, const Vector& acceleration) { return {state, state, acceleration, acceleration, 0, 0}; }
  /// A step of length `step` [s] of the average acceleration rule with path-averaged tractions.
  /// `gain` of a scheme with filters, b: the stiffness then acts on (u0 + u1)/2 + b (u1 - u0 - d_u).
  static StepBalance mean(const State& before, const State& after, double step, double gain = 0) {
    StepBalance made{before, after, before.velocity, after.velocity, 0.5, 0};
    made.step_ = step;
    if (before.filter.step > 0) made.gain_ = gain;
    return made;
  }
  static StepBalance weighted(const State& before, const State& after, double alpha_f, double alpha_m) {
    return {before, after, before.acceleration, after.acceleration, alpha_f, alpha_m};
  }

  double displacement(Index i) const {
    const double mean = of_begin_ * before_->displacement[i] + of_end_ * after_->displacement[i];
    if (gain_ == 0) return mean;
    return mean + gain_ * (after_->displacement[i] - before_->displacement[i] - before_->filter.displacement[i]);
  }
  double velocity(Index i) const {
    if (step_ > 0) return (after_->displacement[i] - before_->displacement[i]) / step_;
    return of_begin_ * before_->velocity[i] + of_end_ * after_->velocity[i];
  }
  double acceleration(Index i) const {
    if (step_ > 0) return ((*last_)[i] - (*first_)[i]) / step_;
    return first_share_ * (*first_)[i] + (1 - first_share_) * (*last_)[i];
  }
  /// Interface force of a row [N].
  double force(Index row) const {
    if (step_ > 0) return after_->mean_force[row];
    return of_begin_ * before_->force[row] + of_end_ * after_->force[row];
  }
  /// A load's function of time, or a derivative of it.
  double value(const TimeFunction& function, int derivative) const {
    if (rests_) return 0;
    const double end = of_end_ * derivative_of(function, derivative, after_->time);
    return of_begin_ == 0 ? end : end + of_begin_ * derivative_of(function, derivative, before_->time);
  }
  /// Displacement (derivative 0), velocity or acceleration that a prescribed motion has for a shape of 1.
  double motion(const TimeFunction& function, int derivative) const {
    if (!rests_) return value(function, derivative);
    return derivative == 0 ? after_->load_factor * function.value(after_->time) : 0;
  }
  /// Share of the constant loads.
  double load_factor() const { return rests_ ? after_->load_factor : 1; }
  /// Loads that are functions of time act.
  bool moves() const { return !rests_; }
  double time() const { return of_begin_ * before_->time + of_end_ * after_->time; }
  double share_of_begin() const { return of_begin_; }
  const State& before() const { return *before_; }
  const State& after() const { return *after_; }

 private:
  StepBalance(const State& before, const State& after, const Vector& first, const Vector& last, double of_begin, double first_share)
      : before_(&before),
        after_(&after),
        first_(&first),
        last_(&last),
        of_begin_(of_begin),
        of_end_(1 - of_begin),
        first_share_(first_share) {}

  const State *before_, *after_;
  const Vector *first_, *last_;  // velocities of both ends for a mean, else accelerations
  double of_begin_, of_end_, first_share_;
  double step_ = 0;  // > 0: means over a step
  double gain_ = 0;  // of the filters of the scheme
  bool rests_ = false;
};

}  // namespace uplift
