#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "uplift/motion/oscillator.h"
#include "uplift/motion/parallel.h"
#include "uplift/motion/spectrum.h"

// RotD50 and RotD100: D. M. Boore, Orientation-independent, nongeometric-mean measures of seismic intensity from two horizontal components
// of motion, BSSA 100 (2010). The oscillator is linear: its response in a direction is the same combination of the two responses.
namespace uplift {

namespace {

constexpr int directions = 180;  // one degree apart; a response and its negative count alike

/// Largest |x cos + y sin| so far in every direction.
class Largest {
 public:
  Largest() {
    for (int k = 0; k < directions; ++k) {
      const double angle = std::numbers::pi * k / directions;
      cosine_[k] = std::cos(angle);
      sine_[k] = std::sin(angle);
    }
  }
  /// A point nearer to the origin than the smallest of them changes nothing: most points do not. (That smallest value is found anew after
  /// every point that did.)
  void add(double x, double y) {
    if (x * x + y * y <= least_squared_) return;
    for (int k = 0; k < directions; ++k) value_[k] = std::max(value_[k], std::abs(x * cosine_[k] + y * sine_[k]));
    double least = value_[0];
    for (int k = 1; k < directions; ++k) least = std::min(least, value_[k]);
    least_squared_ = least * least;
  }
  const std::array<double, directions>& values() const { return value_; }

 private:
  std::array<double, directions> cosine_{}, sine_{}, value_{};
  double least_squared_ = 0;
};

struct State {
  double p = 0, q = 0;
  void advance(const OscillatorStep& s, double from, double to) {
    const double next = s.pp * p + s.pq * q + s.p0 * from + s.p1 * to;
    q = s.qp * p + s.qq * q + s.q0 * from + s.q1 * to;
    p = next;
  }
};

struct Oscillator {
  double frequency, damping, step;
  Spectrum::Kind kind;

  double response(const State& s) const {
    if (kind == Spectrum::Kind::sa) return s.p + 2 * damping * s.q;
    return kind == Spectrum::Kind::sv ? s.q : s.p;
  }
  /// From the variables of the step to SI.
  double unit() const {
    const double omega = 2 * std::numbers::pi * frequency;
    if (kind == Spectrum::Kind::sv) return 1 / omega;
    return kind == Spectrum::Kind::sd ? 1 / (omega * omega) : 1;
  }
};

std::array<double, directions> largest_of(const Oscillator& oscillator, std::span<const double> first, std::span<const double> second) {
  const int subs = sub_steps(oscillator.frequency, oscillator.step);
  const OscillatorStep step = oscillator_step(oscillator.frequency, oscillator.damping, oscillator.step / subs);
  State x, y;
  Largest largest;
  for (std::size_t i = 1; i < first.size(); ++i) {
    const double change_x = (first[i] - first[i - 1]) / subs, change_y = (second[i] - second[i - 1]) / subs;
    for (int sub = 0; sub < subs; ++sub) {
      x.advance(step, first[i - 1] + sub * change_x, first[i - 1] + (sub + 1) * change_x);
      y.advance(step, second[i - 1] + sub * change_y, second[i - 1] + (sub + 1) * change_y);
      largest.add(oscillator.response(x), oscillator.response(y));
    }
  }
  return largest.values();
}

}  // namespace

RotatedSpectra rotated_spectra(std::span<const double> first, std::span<const double> second, double step,
                               const std::vector<double>& frequencies, double damping, Spectrum::Kind kind, int threads) {
  assert(first.size() == second.size() && step > 0 && damping >= 0 && damping < 1);
  const Spectrum empty{kind, damping, frequencies, std::vector<double>(frequencies.size())};
  RotatedSpectra spectra{empty, empty, std::vector<double>(frequencies.size())};
  in_parallel(static_cast<int>(frequencies.size()), threads, [&](int number) {
    const auto i = frequencies.size() - 1 - static_cast<std::size_t>(number);  // the highest frequencies take longest
    const Oscillator oscillator{frequencies[i], damping, step, kind};
    std::array<double, directions> values = largest_of(oscillator, first, second);
    const auto top = std::ranges::max_element(values);
    spectra.largest.values[i] = oscillator.unit() * *top;
    spectra.largest_direction[i] = std::numbers::pi * static_cast<double>(top - values.begin()) / directions;
    std::ranges::sort(values);
    spectra.median.values[i] = oscillator.unit() * (values[directions / 2 - 1] + values[directions / 2]) / 2;
  });
  return spectra;
}

}  // namespace uplift
