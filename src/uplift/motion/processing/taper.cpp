// Cosine taper: the ends of a record brought to zero without a jump of value or slope.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "uplift/motion/processing/step.h"

namespace uplift {

namespace {

class Taper final : public ProcessStep {
 public:
  explicit Taper(const Values& v) : ProcessStep(v), share_(v.number("share")) {
    if (v.has("start")) start_ = v.number("start");
    if (v.has("end")) end_ = v.number("end");
  }

  Motion apply(Motion motion) const override {
    const double duration = motion.duration(), start = start_.value_or(share_ * duration), end = end_.value_or(share_ * duration);
    if (start + end > duration * (1 + 1e-9))
      refuse("", fmt::format("tapers no longer than the record ({:g} s)", duration), fmt::format("{:g} s + {:g} s", start, end));
    for (std::size_t i = 0; i < motion.values.size(); ++i) {
      const double time = motion.step * static_cast<double>(i);
      motion.values[i] *= weight(time, start) * weight(duration - time, end);
    }
    motion.processing.push_back(fmt::format("Cosine taper over the first {:.4g} s and the last {:.4g} s.", start, end));
    return motion;
  }

 private:
  /// From 0 at the end of the record to 1 at `length` from it.
  static double weight(double distance, double length) {
    if (distance >= length) return 1;
    return 0.5 * (1 - std::cos(std::numbers::pi * std::max(distance, 0.0) / length));
  }
  double share_;
  std::optional<double> start_, end_;
};

}  // namespace

const Entry<Processing>& entry_process_taper() {
  static const Entry<Processing> entry{
      {.name = "taper",
       .summary = "cosine taper at both ends",
       .equations = "a(t) -> w(t) w(duration - t) a(t),   w(s) = (1 - cos(pi s/length))/2 for s < length, else 1",
       .source = "",
       .params = {number("share", "1", "length of each taper as a share of the duration").between(0, 0.5).standard(0.05),
                  number("start", "s", "length of the taper at the beginning; absent: by share").nonnegative().optional(),
                  number("end", "s", "length of the taper at the end; absent: by share").nonnegative().optional()}},
      [](const Values& v) { return std::make_unique<Taper>(v); }};
  return entry;
}

}  // namespace uplift
