// Another step: band-limited, by a sinc function under a window, or straight lines between the points.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "uplift/motion/processing/step.h"

namespace uplift {

namespace {

using std::numbers::pi;

/// Zeros of the sinc function to either side that are kept. The window (four terms of Blackman and Harris, side lobes below -92 dB) widens
/// the edge of the band by 4/zeros of the Nyquist frequency to either side.
constexpr int zeros = 64;

/// sin(pi x)/(pi x) under the window, 0 for |x| >= zeros.
double kernel(double x) {
  if (x == 0) return 1;
  if (std::abs(x) >= zeros || x == std::round(x)) return 0;
  const double w = pi * x / zeros;
  const double window = 0.35875 + 0.48829 * std::cos(w) + 0.14128 * std::cos(2 * w) + 0.01168 * std::cos(3 * w);
  return window * std::sin(pi * x) / (pi * x);
}

/// Value at `place` (in steps of the record) of the values as a band-limited function, zero outside; `band` <= 1: share of the record's own
/// band that is kept. A constant stays what it is.
double band_limited(const std::vector<double>& values, double place, double band) {
  const double reach = zeros / band;
  double sum = 0, weights = 0;
  for (double i = std::ceil(place - reach); i <= place + reach; ++i) {
    const double weight = kernel(band * (i - place));
    weights += weight;
    if (i >= 0 && i < static_cast<double>(values.size())) sum += weight * values[static_cast<std::size_t>(i)];
  }
  return sum / weights;
}

double straight(const std::vector<double>& values, double place) {
  const auto i = std::min(static_cast<std::size_t>(place), values.size() - 2);
  return std::lerp(values[i], values[i + 1], place - static_cast<double>(i));
}

class Resample final : public ProcessStep {
 public:
  explicit Resample(const Values& v) : ProcessStep(v), step_(v.number("step")), linear_(v.text("between") == "straight") {}

  Motion apply(Motion motion) const override {
    const double last = static_cast<double>(motion.values.size() - 1), ratio = step_ / motion.step;
    const double count = std::floor(last / ratio + 1e-9) + 1;
    if (count < 2)
      refuse("step", fmt::format("a step no longer than the record ({:g} s)", motion.duration()), fmt::format("{:g} s", step_));
    if (count > most) refuse("step", fmt::format("a step that gives {:g} points at most", most), fmt::format("{:g} points", count));
    std::vector<double> values(static_cast<std::size_t>(count));
    const double band = std::min(1.0, 1 / ratio);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double place = whole(std::min(ratio * static_cast<double>(k), last));
      values[k] = linear_ ? straight(motion.values, place) : band_limited(motion.values, place, band);
    }
    motion.processing.push_back(fmt::format("Resampled from {:.6g} s to {:.6g} s, {}.", motion.step, step_,
                                            linear_ ? "straight between the points" : "band-limited (windowed sinc)"));
    motion.values = std::move(values);
    motion.step = step_;
    return motion;
  }

 private:
  static constexpr double most = 1e7;  // points
  /// A place that is a point of the record but for round-off is that point.
  static double whole(double place) {
    const double near = std::round(place);
    return std::abs(place - near) < 1e-7 ? near : place;
  }
  double step_;
  bool linear_;
};

}  // namespace

const Entry<Processing>& entry_process_resample() {
  static const Entry<Processing> entry{
      {.name = "resample",
       .summary = "another step; finer steps keep the points of the record where they coincide",
       .equations = "band-limited: a(t) = sum of a[i] w(x) sin(pi x)/(pi x), x = b (t - t[i])/step, b = min(1, step/new step), w a window "
                    "of 64 zeros to either side; the record is zero outside",
       .source = "Harris, Proc. IEEE 66 (1978), for the window",
       .params = {number("step", "s", "new step").positive(),
                  choice("between", {"band_limited", "straight"}, "what the motion is between its points").standard("band_limited")}},
      [](const Values& v) { return std::make_unique<Resample>(v); }};
  return entry;
}

}  // namespace uplift
