// Butterworth filters run forwards and backwards: no shift of phase, the gain of one run squared. Applied to the Fourier transform, where
// both runs together are one real factor and no digital approximation of the analogue filter is needed. Zeros before and after keep the
// ends of the record from meeting: Converse and Brady, USGS Open-File Report 92-296A (1992).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "uplift/math/fourier.h"
#include "uplift/motion/formats/convert.h"
#include "uplift/motion/processing/step.h"

namespace uplift {

namespace {

class Bandpass final : public ProcessStep {
 public:
  explicit Bandpass(const Values& v) : ProcessStep(v), order_(v.integer("order")), keep_(v.flag("keep_padding")) {
    if (v.has("low")) low_ = v.number("low");
    if (v.has("high")) high_ = v.number("high");
    if (!low_ && !high_) refuse("", "one corner at least: low, high or both", "neither");
    if (low_ && high_ && !(*low_ < *high_))
      refuse("low", fmt::format("a frequency below high ({:g} Hz)", *high_), fmt::format("{:g} Hz", *low_));
  }

  Motion apply(Motion motion) const override {
    const double nyquist = 0.5 / motion.step;
    for (const auto& [key, corner] : {std::pair{"low", low_}, std::pair{"high", high_}})
      if (corner && *corner >= nyquist)
        refuse(key, fmt::format("a frequency below {:g} Hz (half of one over the step)", nyquist), fmt::format("{:g} Hz", *corner));
    const double wanted_pad = padding(motion.step);
    if (wanted_pad > most_padding)
      refuse(low_ ? "low" : "high",
             fmt::format("a corner of {:.3g} Hz at least ({:g} points before and after)",
                         wanted_pad * (low_ ? *low_ : *high_) / most_padding, most_padding),
             fmt::format("{:g} Hz", low_ ? *low_ : *high_));
    const std::size_t count = motion.values.size(), pad = static_cast<std::size_t>(wanted_pad);
    std::vector<double> padded(fourier_length(count + 2 * pad));
    std::ranges::copy(motion.values, padded.begin() + static_cast<std::ptrdiff_t>(pad));

    std::vector<std::complex<double>> transform = fourier(padded);
    const double spacing = 1 / (motion.step * static_cast<double>(padded.size()));
    for (std::size_t k = 0; k < transform.size(); ++k) transform[k] *= gain(spacing * static_cast<double>(k));
    padded = inverse_fourier(transform, padded.size());

    const auto begin = padded.begin() + static_cast<std::ptrdiff_t>(keep_ ? 0 : pad);
    motion.values.assign(begin, begin + static_cast<std::ptrdiff_t>(keep_ ? count + 2 * pad : count));
    motion.processing.push_back(sentence(motion.step * static_cast<double>(pad)) + left_over(motion));
    return motion;
  }

 private:
  static constexpr double most_padding = 1e7;  // points
  double gain(double frequency) const {
    double product = 1;
    if (high_) product /= 1 + std::pow(frequency / *high_, 2 * order_);
    if (low_) product *= frequency > 0 ? 1 / (1 + std::pow(*low_ / frequency, 2 * order_)) : 0;
    return product;
  }
  /// Zeros on either side: the length after which the slowest corner has died out.
  double padding(double step) const {
    constexpr double periods = 1.5;
    return std::ceil(periods * order_ / (low_ ? *low_ : *high_) / step);
  }
  std::string sentence(double pad) const {
    std::string band = low_ && high_ ? fmt::format("Band-pass {:g} Hz to {:g} Hz", *low_, *high_)
                       : low_        ? fmt::format("High-pass {:g} Hz", *low_)
                                     : fmt::format("Low-pass {:g} Hz", *high_);
    return fmt::format("{}, Butterworth of order {} forwards and backwards (zero phase), zeros over {:.4g} s before and after{}.", band,
                       order_, pad, keep_ ? ", kept" : ", cut away again");
  }
  /// What the filter has spread over the time that was cut away is missing in the integrals.
  std::string left_over(const Motion& motion) const {
    constexpr double felt = 0.01;
    if (keep_ || !low_ || motion.kind != MotionKind::acceleration) return {};
    const std::vector<double> velocity = integrals_of(motion.values, motion.step).velocity;
    double most = 0;
    for (const double value : velocity) most = std::max(most, std::abs(value));
    if (std::abs(velocity.back()) <= felt * most) return {};
    return fmt::format(
        " Without what was cut away the velocity ends at {:.3g} m/s, {:.2g} % of its peak, and the displacement goes on; keep_padding = "
        "true keeps it, a baseline with end = \"velocity\" mends it.",
        velocity.back(), 100 * std::abs(velocity.back()) / most);
  }
  int order_;
  bool keep_;
  std::optional<double> low_, high_;
};

}  // namespace

const Entry<Processing>& entry_process_bandpass() {
  static const Entry<Processing> entry{
      {.name = "bandpass",
       .summary = "Butterworth filter without shift of phase: band-pass, high-pass (low alone) or low-pass (high alone)",
       .equations = "A(f) -> A(f)/((1 + (low/f)^(2 order))(1 + (f/high)^(2 order))): at a corner one half is left (-6 dB)",
       .source = "Converse and Brady, USGS Open-File Report 92-296A (1992); Boore and Bommer, Soil Dyn. Earthq. Eng. 25 (2005)",
       .params = {number("low", "Hz", "lower corner; absent: low frequencies stay").positive().optional(),
                  number("high", "Hz", "upper corner; absent: high frequencies stay").positive().optional(),
                  integer("order", "order of one run").between(1, 10).standard(4),
                  flag("keep_padding",
                       "keep the time before and after with what the filter spreads there (1.5 order/low to either side): "
                       "velocity and displacement then end at zero")
                      .standard(false)}},
      [](const Values& v) { return std::make_unique<Bandpass>(v); }};
  return entry;
}

}  // namespace uplift
