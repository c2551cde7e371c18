#include "uplift/dynamics/step.h"

// Lower sides of interfaces that prescribed motions move.
namespace uplift {

/// Openings that prescribed motions make by themselves, at the end of a step.
void Stepper::move_gap(double from, double to) {
  gap_ = still_gap_;
  gap_step_.setZero();
  for (const PrescribedMotion& motion : model_.motions) {
    const double now = motion.function->value(to);
    gap_ += motion.opening * now;
    gap_step_ += motion.opening * (now - motion.function->value(from));
  }
}

/// And their rates, which impacts and held points need; a jump of the velocity is in the velocity alone.
void Stepper::move_rates(double time) {
  moved_velocity_.setZero(b_.rows());
  moved_acceleration_.setZero(b_.rows());
  for (const PrescribedMotion& motion : model_.motions) {
    moved_velocity_ += motion.opening * motion.function->rate(time);
    moved_acceleration_ += motion.opening * motion.function->smooth_acceleration(time);
  }
}

}  // namespace uplift
