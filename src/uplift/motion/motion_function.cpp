#include "uplift/motion/motion_function.h"

#include <algorithm>
#include <cassert>

#include "uplift/motion/formats/convert.h"

namespace uplift {

MotionHistory::MotionHistory(std::shared_ptr<const Motion> motion) : motion_(std::move(motion)) {
  assert(motion_->values.size() >= 2 && motion_->step > 0);
  Integrals integrals = integrals_of(motion_->values, motion_->step);
  once_ = std::move(integrals.velocity);
  twice_ = std::move(integrals.displacement);
}

double MotionHistory::integrated(int times, double time) const {
  const std::vector<double>& given = motion_->values;
  const double h = motion_->step, place = time / h, last = static_cast<double>(given.size() - 1);
  if (!(time >= 0) || times < -1) return 0;
  if (place > last * (1 + 1e-12)) {
    const double since = time - h * last, held = motion_->kind == MotionKind::acceleration ? 0 : given.back();
    if (times <= 0) return times == 0 ? held : 0;
    if (times == 1) return once_.back() + since * held;
    return twice_.back() + since * (once_.back() + since / 2 * held);
  }
  const std::size_t i = std::min(static_cast<std::size_t>(place), given.size() - 2);
  const double s = time - h * static_cast<double>(i), slope = (given[i + 1] - given[i]) / h;
  if (times == -1) return slope;
  if (times == 0) return given[i] + s * slope;
  if (times == 1) return once_[i] + s * (given[i] + s / 2 * slope);
  return twice_[i] + s * (once_[i] + s / 2 * (given[i] + s / 3 * slope));
}

MotionFunction::MotionFunction(std::shared_ptr<const MotionHistory> history, MotionKind kind, double share)
    : history_(std::move(history)), order_(history_->order(kind)) {
  if (order_ != 2) return;  // without an acceleration that was given there is nothing to agree with
  share_ = share;
  first_ = history_->integrated(0, 0);
}

double MotionFunction::value(double time) const {
  const double exact = history_->integrated(order_, time);
  return share_ == 0 ? exact : exact + share_ * (history_->integrated(0, time) - first_);
}

}  // namespace uplift
