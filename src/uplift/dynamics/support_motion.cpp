#include "uplift/dynamics/support_motion.h"

namespace uplift {

SupportMotion::SupportMotion(const Model& model, const Vector& still_gap)
    : model_(model), still_gap_(still_gap), gap_(still_gap), change_(Vector::Zero(still_gap.size())) {
  for (const PrescribedMotion& motion : model.motions) acts_ = acts_ || (motion.opening.size() > 0 && !motion.opening.isZero(0));
}

void SupportMotion::go(double from, double to) {
  gap_ = still_gap_;
  change_.setZero();
  for (const PrescribedMotion& motion : model_.motions) {
    const double now = motion.function->value(to);
    gap_ += motion.opening * now;
    change_ += motion.opening * (now - motion.function->value(from));
  }
}

void SupportMotion::set_rates(double time) {
  velocity_.setZero(still_gap_.size());
  acceleration_.setZero(still_gap_.size());
  add_velocity(time, velocity_);
  for (const PrescribedMotion& motion : model_.motions) acceleration_ += motion.opening * motion.function->smooth_acceleration(time);
}

void SupportMotion::add_velocity(double time, Vector& rates) const {
  for (const PrescribedMotion& motion : model_.motions) rates += motion.opening * motion.function->rate(time);
}

}  // namespace uplift
