// Functions of time in closed form. All are shapes without unit that multiply an amplitude; rate and acceleration are their derivatives
// [1/s, 1/s2].
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "uplift/model/function_jumps.h"

namespace uplift {

namespace {

using std::numbers::pi;

class Constant : public TimeFunction {
 public:
  explicit Constant(double value) : value_(value) {}
  double value(double) const override { return value_; }
  double rate(double) const override { return 0; }
  double acceleration(double) const override { return 0; }

 private:
  double value_;
};

/// A sin(w (t - start) + phase) inside [start, end], 0 outside.
class Sine : public TimeFunction {
 public:
  Sine(double amplitude, double omega, double phase, double start, double end)
      : amplitude_(amplitude), omega_(omega), phase_(phase), start_(start), end_(end) {}
  double value(double t) const override { return inside(t) ? amplitude_ * std::sin(angle(t)) : 0; }
  double rate(double t) const override { return inside(t) ? amplitude_ * omega_ * std::cos(angle(t)) : 0; }
  double acceleration(double t) const override { return inside(t) ? -amplitude_ * omega_ * omega_ * std::sin(angle(t)) : 0; }
  std::vector<FunctionBend> bends() const {
    std::vector<FunctionBend> found{{start_, rate(start_), 0}};
    if (std::isfinite(end_)) found.push_back({end_, -rate(end_), 0});
    return found;
  }

 private:
  bool inside(double t) const { return t >= start_ && t <= end_; }
  double angle(double t) const { return omega_ * (t - start_) + phase_; }
  double amplitude_, omega_, phase_, start_, end_;
};

class Ramp : public TimeFunction {
 public:
  Ramp(double from, double to, double start, double duration) : from_(from), to_(to), start_(start), duration_(duration) {}
  double value(double t) const override {
    if (t <= start_) return from_;
    if (t >= start_ + duration_) return to_;
    return from_ + (to_ - from_) * (t - start_) / duration_;
  }
  double rate(double t) const override { return t > start_ && t < start_ + duration_ ? (to_ - from_) / duration_ : 0; }
  double acceleration(double) const override { return 0; }
  std::vector<FunctionBend> bends() const {
    const double slope = (to_ - from_) / duration_;
    return {{start_, slope, 0}, {start_ + duration_, -slope, 0}};
  }

 private:
  double from_, to_, start_, duration_;
};

/// A (1 - 2 s^2) exp(-s^2), s = pi f (t - delay).
class Ricker : public TimeFunction {
 public:
  Ricker(double amplitude, double frequency, double delay) : amplitude_(amplitude), scale_(pi * frequency), delay_(delay) {}
  double value(double t) const override {
    const double s2 = square(t);
    return amplitude_ * (1 - 2 * s2) * std::exp(-s2);
  }
  double rate(double t) const override {
    const double s = scale_ * (t - delay_), s2 = s * s;
    return amplitude_ * scale_ * s * (4 * s2 - 6) * std::exp(-s2);
  }
  double acceleration(double t) const override {
    const double s2 = square(t);
    return amplitude_ * scale_ * scale_ * (-6 + 24 * s2 - 8 * s2 * s2) * std::exp(-s2);
  }

 private:
  double square(double t) const { return std::pow(scale_ * (t - delay_), 2); }
  double amplitude_, scale_, delay_;
};

Field amplitude() {
  return number("amplitude", "1", "largest value").standard(1.0);
}
Field start() {
  return number("start", "s", "time at which it begins").standard(0.0);
}

class Pulses final : public TimeFunction {
 public:
  Pulses(std::shared_ptr<const TimeFunction> function, std::vector<FunctionBend> bends)
      : function_(std::move(function)), bends_(std::move(bends)) {}
  double value(double t) const override { return function_->value(t); }
  double rate(double t) const override { return function_->rate(t); }
  double acceleration(double t) const override {
    double sum = function_->acceleration(t);
    for (const FunctionBend& bend : bends_)
      sum += bend.change * std::max(0.0, 1 - std::abs(t - bend.time) / bend.half_width) / bend.half_width;
    return sum;
  }
  double smooth_acceleration(double t) const override { return function_->smooth_acceleration(t); }
  bool is_one() const override { return function_->is_one(); }

 private:
  std::shared_ptr<const TimeFunction> function_;
  std::vector<FunctionBend> bends_;
};

}  // namespace

const Entry<TimeFunction>& entry_function_constant() {
  static const Entry<TimeFunction> entry{{.name = "constant",
                                          .summary = "the same value at all times",
                                          .equations = "f(t) = value",
                                          .source = "",
                                          .params = {number("value", "1", "value").standard(1.0)}},
                                         [](const Values& v) { return std::make_unique<Constant>(v.number("value")); }};
  return entry;
}

const Entry<TimeFunction>& entry_function_half_sine() {
  static const Entry<TimeFunction> entry{{.name = "half_sine",
                                          .summary = "one half wave of a sine, zero before and after: a soft shock",
                                          .equations = "f(t) = amplitude sin(pi (t - start)/duration)   for start <= t <= start + duration",
                                          .source = "",
                                          .params = {amplitude(), number("duration", "s", "length of the half wave").positive(), start()}},
                                         [](const Values& v) {
                                           const double duration = v.number("duration"), begin = v.number("start");
                                           return std::make_unique<Sine>(v.number("amplitude"), pi / duration, 0.0, begin,
                                                                         begin + duration);
                                         }};
  return entry;
}

const Entry<TimeFunction>& entry_function_ramp() {
  static const Entry<TimeFunction> entry{
      {.name = "ramp",
       .summary = "from one value to another along a straight line, constant before and after",
       .equations = "f(t) = from + (to - from)(t - start)/duration",
       .source = "",
       .params = {number("from", "1", "value before").standard(0.0), number("to", "1", "value after").standard(1.0), start(),
                  number("duration", "s", "length of the ramp").positive()}},
      [](const Values& v) { return std::make_unique<Ramp>(v.number("from"), v.number("to"), v.number("start"), v.number("duration")); }};
  return entry;
}

const Entry<TimeFunction>& entry_function_ricker() {
  static const Entry<TimeFunction> entry{
      {.name = "ricker",
       .summary = "Ricker wavelet: one pulse with a smooth spectrum around a frequency, without a permanent part",
       .equations = "f(t) = amplitude (1 - 2 s^2) exp(-s^2),   s = pi frequency (t - delay)",
       .source = "Ricker, Geophysics 18 (1953)",
       .params = {amplitude(), number("frequency", "Hz", "frequency of the largest spectral value").positive(),
                  number("delay", "s", "time of the peak; absent: 1.5/frequency, so that f(0) is negligible").optional()}},
      [](const Values& v) {
        const double frequency = v.number("frequency");
        return std::make_unique<Ricker>(v.number("amplitude"), frequency, v.has("delay") ? v.number("delay") : 1.5 / frequency);
      }};
  return entry;
}

const Entry<TimeFunction>& entry_function_harmonic() {
  static const Entry<TimeFunction> entry{{.name = "harmonic",
                                          .summary = "a sine wave from a start to an end",
                                          .equations = "f(t) = amplitude sin(2 pi frequency (t - start) + phase)   for start <= t <= end",
                                          .source = "",
                                          .params = {amplitude(), number("frequency", "Hz", "frequency").positive(),
                                                     number("phase", "rad", "phase at the start").standard(0.0), start(),
                                                     number("end", "s", "time at which it ends; absent: never").optional()}},
                                         [](const Values& v) {
                                           const double end = v.has("end") ? v.number("end") : std::numeric_limits<double>::infinity();
                                           return std::make_unique<Sine>(v.number("amplitude"), 2 * pi * v.number("frequency"),
                                                                         v.number("phase"), v.number("start"), end);
                                         }};
  return entry;
}

std::vector<FunctionBend> bends_of(const TimeFunction& function) {
  if (const auto* sine = dynamic_cast<const Sine*>(&function)) return sine->bends();
  if (const auto* ramp = dynamic_cast<const Ramp*>(&function)) return ramp->bends();
  return bends_of_table(function);
}

std::shared_ptr<const TimeFunction> with_pulses(std::shared_ptr<const TimeFunction> function, std::vector<FunctionBend> bends) {
  return std::make_shared<Pulses>(std::move(function), std::move(bends));
}

}  // namespace uplift
