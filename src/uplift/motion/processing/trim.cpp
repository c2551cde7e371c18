// A part of a record, by times or by what share of its Arias intensity is kept.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "uplift/motion/intensity.h"
#include "uplift/motion/processing/step.h"

namespace uplift {

namespace {

class Trim final : public ProcessStep {
 public:
  explicit Trim(const Values& v) : ProcessStep(v) {
    if (v.has("from")) from_ = v.number("from");
    if (v.has("to")) to_ = v.number("to");
    if (v.has("arias")) arias_ = v.numbers("arias");
    if (arias_.empty()) return;
    if (from_ || to_) refuse("arias", "either times or shares of the Arias intensity", "both");
    if (!(arias_[0] >= 0 && arias_[0] < arias_[1] && arias_[1] <= 1))
      refuse("arias", "two shares from 0 to 1, ascending", fmt::format("{:g}, {:g}", arias_[0], arias_[1]));
  }

  Motion apply(Motion motion) const override {
    const double duration = motion.duration();
    double from = from_.value_or(0), to = to_.value_or(duration);
    if (!arias_.empty()) {
      need_acceleration(motion);
      from = arias_time(motion, arias_[0]);
      to = arias_time(motion, arias_[1]);
    }
    // whole steps; a time that is a point but for round-off is that point
    const double last = static_cast<double>(motion.values.size() - 1);
    const double first_kept = arias_.empty() ? std::ceil(from / motion.step - 1e-6) : std::floor(from / motion.step + 1e-6);
    const double last_kept = std::min(arias_.empty() ? std::floor(to / motion.step + 1e-6) : std::ceil(to / motion.step - 1e-6), last);
    if (first_kept + 1 > last_kept || to > duration + 0.5 * motion.step)
      refuse(to_ ? "to" : "from", fmt::format("times within the record (0 to {:g} s) with one step between them at least", duration),
             fmt::format("{:g} s to {:g} s", from, to));
    const auto begin = motion.values.begin();
    motion.values =
        std::vector<double>(begin + static_cast<std::ptrdiff_t>(first_kept), begin + static_cast<std::ptrdiff_t>(last_kept) + 1);
    motion.processing.push_back(sentence(first_kept * motion.step, last_kept * motion.step, duration));
    return motion;
  }

 private:
  std::string sentence(double from, double to, double duration) const {
    std::string text = fmt::format("Trimmed to {:.6g} s ... {:.6g} s of {:.6g} s", from, to, duration);
    if (!arias_.empty()) text += fmt::format(" ({:g} % to {:g} % of the Arias intensity)", 100 * arias_[0], 100 * arias_[1]);
    return text + "; time begins anew at zero.";
  }
  std::optional<double> from_, to_;
  std::vector<double> arias_;
};

}  // namespace

const Entry<Processing>& entry_process_trim() {
  static const Entry<Processing> entry{
      {.name = "trim",
       .summary = "a part of the record, by times or by shares of the Arias intensity",
       .equations = "whole steps are kept; time begins anew at zero. Components of one record are trimmed alike by times only.",
       .source = "",
       .params = {number("from", "s", "first time kept; absent: the beginning").nonnegative().optional(),
                  number("to", "s", "last time kept; absent: the end").positive().optional(),
                  numbers("arias", "1", "shares of the Arias intensity instead of times: [0.001, 0.999]", 2).optional()}},
      [](const Values& v) { return std::make_unique<Trim>(v); }};
  return entry;
}

}  // namespace uplift
