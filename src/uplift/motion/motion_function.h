#pragma once
#include <memory>
#include <vector>

#include "uplift/model/function.h"
#include "uplift/motion/motion.h"

namespace uplift {

/// A motion with its integrals over time: what is given is straight between its points, its integrals are exact and begin with zero.
/// Before its first point nothing moves; after its last one an acceleration is zero, and a velocity or a displacement given goes on with
/// its last value.
class MotionHistory {
 public:
  /// The motion has two values at least and a step > 0.
  explicit MotionHistory(std::shared_ptr<const Motion> motion);
  const std::shared_ptr<const Motion>& motion() const { return motion_; }
  /// Whether a quantity is given or follows by integration; what is left would need the derivative of straight lines.
  bool gives(MotionKind kind) const { return kind >= motion_->kind; }
  /// The quantity integrated `times` from the given one; -1: the slope of its straight pieces (to the right of a point), less: zero.
  double integrated(int times, double time) const;
  double at(MotionKind kind, double time) const { return integrated(order(kind), time); }
  int order(MotionKind kind) const { return static_cast<int>(kind) - static_cast<int>(motion_->kind); }

 private:
  std::shared_ptr<const Motion> motion_;
  std::vector<double> once_, twice_;  // integrals at the points
};

/// What a record drives: one quantity of a motion, with its derivatives, per unit of the quantity.
class MotionFunction final : public TimeFunction {
 public:
  /// `share` [s2]: what is added to a displacement, times a(t) - a(0). A run with Newmark's formulas and the step dt turns an acceleration
  /// that is straight between its steps into the displacement u + (beta - 1/6) dt2 (a(t) - a(0)), because
  ///   u1 = u0 + dt v0 + dt2 ((1/2 - beta) a0 + beta a1)   against the exact   u0 + dt v0 + dt2 (a0/3 + a1/6),
  /// and the differences add up to this. With it a run with a moving base and one in the frame that moves with the base are the same.
  MotionFunction(std::shared_ptr<const MotionHistory> history, MotionKind kind, double share = 0);
  double value(double time) const override;
  double rate(double time) const override { return history_->integrated(order_ - 1, time); }
  double acceleration(double time) const override { return history_->integrated(order_ - 2, time); }

 private:
  std::shared_ptr<const MotionHistory> history_;
  int order_;
  double share_ = 0, first_ = 0;
};

}  // namespace uplift
