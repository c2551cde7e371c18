#pragma once
#include <memory>
#include <span>

#include "uplift/base/catalog.h"

namespace uplift {

/// A scalar function of time. Its unit is that of what it multiplies; derivatives per s and s2 (prescribed motion needs them).
class TimeFunction {
 public:
  virtual ~TimeFunction() = default;
  virtual double value(double time) const = 0;
  virtual double rate(double time) const = 0;
  virtual double acceleration(double time) const = 0;
  /// The acceleration without the pulses of bends (function_jumps.h), which are as wide as the step of the run, whatever it is.
  virtual double smooth_acceleration(double time) const { return acceleration(time); }
  /// Its value is 1 at all times.
  virtual bool is_one() const { return false; }
};

/// The function itself (0), its first (1) or second (2) derivative.
inline double derivative_of(const TimeFunction& function, int derivative, double time) {
  return derivative == 0 ? function.value(time) : derivative == 1 ? function.rate(time) : function.acceleration(time);
}

/// The same without the pulses of bends.
inline double smooth_derivative_of(const TimeFunction& function, int derivative, double time) {
  return derivative == 2 ? function.smooth_acceleration(time) : derivative_of(function, derivative, time);
}

/// 1 at all times: what has no function of its own.
class One final : public TimeFunction {
 public:
  double value(double) const override { return 1; }
  double rate(double) const override { return 0; }
  double acceleration(double) const override { return 0; }
  bool is_one() const override { return true; }
};

std::span<const Entry<TimeFunction>* const> function_catalog();
std::span<const PartInfo* const> time_functions();

}  // namespace uplift
