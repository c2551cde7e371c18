// Scaling: one factor on the whole motion, given or found from what the scaled motion shall have.
#include <fmt/format.h>

#include <cmath>

#include "uplift/base/text.h"
#include "uplift/motion/processing/step.h"
#include "uplift/motion/spectrum.h"
#include "uplift/motion/target.h"

namespace uplift {

namespace {

Motion scaled(Motion motion, double factor, const std::string& why) {
  for (double& value : motion.values) value *= factor;
  motion.processing.push_back(fmt::format("Scaled by {:.6g}{}.", factor, why));
  return motion;
}

class Scale final : public ProcessStep {
 public:
  explicit Scale(const Values& v) : ProcessStep(v), damping_(v.number("damping")) {
    std::vector<std::string> given;
    for (const char* key : {"factor", "pga", "sa"})
      if (v.has(key)) given.emplace_back(key), to_ = key, amount_ = v.number(key);
    if (given.size() != 1) refuse("", "one of factor, pga and sa", given.empty() ? "none" : listed(given));
    if ((to_ == "sa") != v.has("period")) refuse("period", "a period together with sa", to_ == "sa" ? "none" : "a period alone");
    if (v.has("period")) period_ = v.number("period");
  }

  Motion apply(Motion motion) const override {
    if (to_ == "factor") return scaled(std::move(motion), amount_, "");
    need_acceleration(motion);
    const double now = to_ == "pga"
                           ? std::abs(peak_of(motion).value)
                           : response_spectra(motion.values, motion.step, {1 / period_}, {damping_}, Spectrum::Kind::psa)[0].values[0];
    if (!(now > 0)) refuse("", "a motion that is not zero throughout", "zeros");
    const std::string what =
        to_ == "pga" ? "peak acceleration" : fmt::format("pseudo-acceleration at {:g} s, {:g} % damping,", period_, 100 * damping_);
    return scaled(std::move(motion), amount_ / now, fmt::format(": {} from {:.5g} m/s2 to {:.5g} m/s2", what, now, amount_));
  }

 private:
  std::string to_;
  double amount_ = 1, period_ = 0, damping_;
};

/// The factor that brings the mean over a range of periods to that of a target: of the logarithms, so that the mean square distance of both
/// spectra on a logarithmic drawing is smallest.
class ScaleToSpectrum final : public ProcessStep {
 public:
  explicit ScaleToSpectrum(const Values& v)
      : ProcessStep(v),
        from_(v.number("from")),
        to_(v.number("to")),
        name_(v.part("target").type()),
        target_(make_part(target_catalog(), v.part("target"))) {
    if (!(from_ < to_)) refuse("to", fmt::format("a period above from ({:g} s)", from_), fmt::format("{:g} s", to_));
  }

  Motion apply(Motion motion) const override {
    need_acceleration(motion);
    constexpr int count = 100;
    const double damping = target_->damping();
    const Spectrum now =
        response_spectra(motion.values, motion.step, log_spaced(1 / to_, 1 / from_, count), {damping}, Spectrum::Kind::psa)[0];
    double sum = 0;
    for (std::size_t i = 0; i < now.values.size(); ++i) {
      if (!(now.values[i] > 0)) refuse("", "a motion that is not zero throughout", "zeros");
      sum += std::log(target_->at(now.frequencies[i]) / now.values[i]);
    }
    return scaled(std::move(motion), std::exp(sum / count),
                  fmt::format(": mean of the target ({}) from {:g} s to {:g} s, {:g} % damping", name_, from_, to_, 100 * damping));
  }

 private:
  double from_, to_;
  std::string name_;
  std::unique_ptr<const TargetSpectrum> target_;
};

Field damping() {
  return number("damping", "1", "damping ratio of the oscillators").between(0, 0.99).standard(0.05);
}

}  // namespace

const Entry<Processing>& entry_process_scale() {
  static const Entry<Processing> entry{
      {.name = "scale",
       .summary = "one factor, given or such that the peak acceleration or a spectral value is reached",
       .equations = "a -> c a,   c = factor, pga/max |a|, or sa/PSA(period, damping)",
       .source = "",
       .params = {number("factor", "1", "factor; negative turns the motion round").optional(),
                  number("pga", "m/s2", "largest acceleration of the scaled motion").positive().optional(),
                  number("sa", "m/s2", "pseudo-acceleration of the scaled motion at `period`").positive().optional(),
                  number("period", "s", "period of the oscillator").positive().optional(), damping()}},
      [](const Values& v) { return std::make_unique<Scale>(v); }};
  return entry;
}

const Entry<Processing>& entry_process_scale_to_spectrum() {
  static const Entry<Processing> entry{
      {.name = "scale_to_spectrum",
       .summary = "the factor that brings the spectrum to a target in the mean over a range of periods",
       .equations = "ln c = mean of ln(target/PSA) over 100 periods, equally spaced in logarithms",
       .source = "",
       .params = {part("target", target_spectra, "the spectrum aimed at, with its damping ratio"),
                  number("from", "s", "shortest period").positive(), number("to", "s", "longest period").positive()}},
      [](const Values& v) { return std::make_unique<ScaleToSpectrum>(v); }};
  return entry;
}

}  // namespace uplift
