#include "uplift/motion/generate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "uplift/math/lanes.h"
#include "uplift/math/linalg.h"
#include "uplift/motion/spectral_fit.h"
#include "uplift/motion/spectrum.h"

// Sums of sines of random phase under an envelope, their amplitudes scaled until the response spectrum is near the target (E. H. Vanmarcke,
// D. A. Gasparini, Simulated earthquake ground motions, SMiRT 4, 1977), then changed as little as possible until it is there
// (motion/spectral_fit.h).
namespace uplift {

namespace {

using std::numbers::pi;

constexpr double grain = 1e-5;  // m/s2: values are whole multiples of it
constexpr int one_thread = 1;   // motions are made side by side

/// Uniform numbers whose bits the C++ standard fixes: its distributions differ between libraries, its engines do not.
class Draw {
 public:
  Draw(std::uint64_t seed, std::uint64_t component, std::uint64_t attempt) : engine_(mixed(mixed(mixed(seed) + component) + attempt)) {}
  /// 0 <= number < 1, 53 bits.
  double operator()() { return std::ldexp(static_cast<double>(engine_() >> 11), -53); }

 private:
  /// Neighbouring seeds far apart: the finaliser of splitmix64 (Steele, Lea and Flood 2014).
  static std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31);
  }
  std::mt19937_64 engine_;
};

std::vector<double> per_decade(double number, double from, double to) {
  return log_spaced(from, to, std::max(2, static_cast<int>(std::ceil(number * std::log10(to / from))) + 1));
}
/// Where a motion is changed.
std::vector<double> fit_frequencies(double from, double to, double damping) {
  return per_decade(damping < 0.02 ? 300 : 100, from, to);
}
/// Where it is judged: so near each other that a spectrum, whose valleys between two of its cycles are sharp, hides no dip between them.
std::vector<double> judged_frequencies(double from, double to, double damping) {
  return per_decade(damping < 0.02 ? 2000 : 1000, from, to);
}

std::span<const double> span_of(const Vector& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

/// The motion before the fit by changes: sines under the envelope.
class Sines {
 public:
  Sines(const GenerateOptions& options, const TargetSpectrum& target, Draw draw) : options_(options) {
    constexpr double per_e = 100;  // sines in a band of frequencies whose ends have the ratio e
    const int count = static_cast<int>(std::ceil(per_e * std::log(options.to / options.from)));
    const double width = std::log(options.to / options.from) / count;
    for (int i = 0; i < count; ++i) {
      frequencies_.push_back(options.from * std::exp(width * (i + draw())));
      phases_.push_back(2 * pi * draw());
      // white noise of density G gives the variance pi f G/(4 zeta); a peak is about 3 standard deviations; amplitude2/2 = G f width
      amplitudes_.push_back(target.at(frequencies_.back()) / 3 * std::sqrt(8 * target.damping() * width / pi));
    }
  }

  Vector sum(const Vector& envelope) const {
    const auto count = static_cast<Index>(frequencies_.size());
    Vector x(count), y(count), c(count), s(count);  // amplitude times cosine and sine of the angle now; those of the angle of a step
    for (Index i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double turn = 2 * pi * frequencies_[at] * options_.step;
      c[i] = std::cos(turn), s[i] = std::sin(turn);
      x[i] = amplitudes_[at] * std::cos(phases_[at]), y[i] = amplitudes_[at] * std::sin(phases_[at]);
    }
    Vector a(envelope.size());
    for (double& value : a) {
      Lanes together = 0;
      for_lanes(count, [&](const auto& at) {
        const Lanes x_now = at(x.data()), y_now = at(y.data()), cosine = at(c.data()), sine = at(s.data());
        together += x_now;
        at.put(x.data(), cosine * x_now - sine * y_now);
        at.put(y.data(), sine * x_now + cosine * y_now);
      });
      value = uplift::sum(together);
    }
    return a.cwiseProduct(envelope);
  }

  /// Every amplitude times what is missing at its frequency.
  void scale(const Vector& acceleration, const TargetSpectrum& target) {
    constexpr double most = 2;
    const std::vector<double> grid = log_spaced(frequencies_.front(), frequencies_.back(), 100);
    const Spectrum reached =
        response_spectra(span_of(acceleration), options_.step, grid, {target.damping()}, Spectrum::Kind::psa, one_thread).front();
    for (std::size_t i = 0; i < frequencies_.size(); ++i)
      amplitudes_[i] *= std::clamp(target.at(frequencies_[i]) / value_at(reached, frequencies_[i]), 1 / most, most);
  }

 private:
  const GenerateOptions& options_;
  std::vector<double> frequencies_, phases_, amplitudes_;
};

/// How far a fit is from what it must be; below 1 it is good.
double shortfall(const SpectrumFit& fit) {
  return std::max(fit.mean_error / 0.05, (1 - fit.least_ratio) / 0.10);
}
/// Nowhere far above the target either.
double distance(const SpectrumFit& fit) {
  return std::max(shortfall(fit), fit.largest_error / 0.25);
}

Vector at_rest_in_grains(Vector a, const Vector& envelope, double step) {
  a += rest_change(a, envelope, step);
  for (double& value : a) value = grain * std::round(value / grain) + 0.0;
  return a;
}

/// The target over the band. Below it the response must not exceed the displacement at the lower end: without that the fit would let the
/// ground drift by metres, which no frequency of the band sees.
SpectralDemand demand_of(const TargetSpectrum& target, const GenerateOptions& options) {
  constexpr int below = 12;
  SpectralDemand demand{.step = options.step, .damping = target.damping(), .frequencies = {}, .target = {}};
  const double lowest = 0.25 / options.duration, limit = 0.95 * options.from;
  if (lowest < limit) demand.frequencies = log_spaced(lowest, limit, below);
  demand.limits = demand.frequencies.size();
  for (const double f : demand.frequencies) demand.target.push_back(target.at(options.from) * (f / options.from) * (f / options.from));
  for (const double f : fit_frequencies(options.from, options.to, target.damping())) {
    demand.frequencies.push_back(f);
    demand.target.push_back(target.at(f));
  }
  demand.peak = target.peak_ground_acceleration();
  return demand;
}

SpectrumFit fit_at(std::vector<double> frequencies, std::span<const double> acceleration, double step, const TargetSpectrum& target) {
  SpectrumFit fit{.damping = target.damping(), .frequencies = std::move(frequencies), .target = {}, .reached = {}};
  fit.reached = response_spectra(acceleration, step, fit.frequencies, {fit.damping}, Spectrum::Kind::psa, one_thread).front().values;
  fit.least_ratio = std::numeric_limits<double>::max();
  const auto count = static_cast<double>(fit.frequencies.size());
  for (std::size_t i = 0; i < fit.frequencies.size(); ++i) {
    fit.target.push_back(target.at(fit.frequencies[i]));
    const double ratio = fit.reached[i] / fit.target[i];
    fit.mean_error += std::abs(ratio - 1) / count;
    fit.mean_ratio += ratio / count;
    fit.largest_error = std::max(fit.largest_error, std::abs(ratio - 1));
    fit.least_ratio = std::min(fit.least_ratio, ratio);
  }
  return fit;
}

/// The bottoms of the dips that a judged motion has between the frequencies of the demand, as further ones.
void add_dips(const SpectrumFit& judged, SpectralDemand& demand) {
  constexpr double shallow = 0.94;
  const auto ratio = [&](std::size_t i) { return judged.reached[i] / judged.target[i]; };
  for (std::size_t i = 1; i + 1 < judged.frequencies.size(); ++i) {
    if (ratio(i) > shallow || ratio(i) > ratio(i - 1) || ratio(i) >= ratio(i + 1)) continue;
    demand.frequencies.push_back(judged.frequencies[i]);
    demand.target.push_back(judged.target[i]);
  }
}

GeneratedMotion one_motion(const TargetSpectrum& target, const GenerateOptions& options, const Draw& draw) {
  const auto points = static_cast<Index>(std::llround(options.duration / options.step)) + 1;
  Vector envelope(points);
  for (Index i = 0; i < points; ++i) envelope[i] = options.envelope.at(static_cast<double>(i) * options.step, options.duration);

  Sines sines(options, target, draw);
  Vector a = sines.sum(envelope);
  constexpr int scalings = 5, most_changes = 40, plenty = 12;
  for (int i = 0; i < scalings; ++i) {
    sines.scale(a, target);
    a = sines.sum(envelope);
  }

  SpectralDemand demand = demand_of(target, options);
  GeneratedMotion best, judged;  // at the frequencies of the demand; at all frequencies
  constexpr double enough = 0.4, sound = 0.9;
  for (int i = 0; i <= most_changes; ++i) {
    const Vector rounded = at_rest_in_grains(a, envelope, options.step);
    const auto band = demand.frequencies.begin() + static_cast<std::ptrdiff_t>(demand.limits);
    SpectrumFit fit = fit_at({band, demand.frequencies.end()}, span_of(rounded), options.step, target);
    if (best.motion.values.empty() || distance(fit) < distance(best.fit)) {
      best.motion.values.assign(rounded.begin(), rounded.end());
      best.fit = std::move(fit);
      best.iterations = i;
    }
    if (distance(best.fit) < (i < plenty ? enough : 1) || i == most_changes) {
      best.fit = spectrum_fit(best.motion.values, options.step, target, options.from, options.to);
      if (judged.motion.values.empty() || shortfall(best.fit) < shortfall(judged.fit)) judged = best;
      if (shortfall(judged.fit) < sound) break;
      add_dips(best.fit, demand);
      best = {};
    }
    a += spectral_change(a, envelope, demand, 0.7);
  }
  return judged;
}

std::string told(const GenerateOptions& options, std::size_t component, const TargetSpectrum& target, const SpectrumFit& fit) {
  const Envelope& envelope = options.envelope;
  const std::string fall = envelope.shape == Envelope::Shape::saragoni_hart ? "" : fmt::format(", falls from {:g} s", envelope.fall);
  return fmt::format(
      "generated from seed {}, component {}, for {}; envelope {} that rises until {:g} s{}; fitted from {:.4g} Hz to {:.4g} Hz at {:g} % "
      "damping: "
      "mean error {:.2f} %, at least {:.1f} % of the target",
      options.seed, component + 1, target.told(), to_string(envelope.shape), envelope.rise, fall, options.from, options.to,
      100 * fit.damping, 100 * fit.mean_error, 100 * fit.least_ratio);
}

}  // namespace

std::string_view to_string(Envelope::Shape shape) {
  switch (shape) {
    case Envelope::Shape::trapezoid:
      return "trapezoid";
    case Envelope::Shape::jennings:
      return "jennings";
    case Envelope::Shape::saragoni_hart:
      return "saragoni_hart";
  }
  return "";
}

double Envelope::at(double time, double duration) const {
  constexpr double at_end = 0.05;
  if (time < 0 || time > duration) return 0;
  switch (shape) {
    case Shape::trapezoid:
      return time < rise ? time / rise : time > fall ? (duration - time) / (duration - fall) : 1;
    case Shape::jennings:
      if (time < rise) return (time / rise) * (time / rise);
      return time > fall ? std::exp(std::log(at_end) * (time - fall) / (duration - fall)) : 1;
    case Shape::saragoni_hart: {
      const double share = rise / duration, b = -share * std::log(at_end) / (1 + share * (std::log(share) - 1)), s = time / rise;
      return time > 0 ? std::exp(b * (1 + std::log(s) - s)) : 0;
    }
  }
  return 0;
}

bool SpectrumFit::good() const {
  return mean_error <= 0.05 && least_ratio >= 0.90;
}

SpectrumFit spectrum_fit(std::span<const double> acceleration, double step, const TargetSpectrum& target, double from, double to) {
  return fit_at(judged_frequencies(from, to, target.damping()), acceleration, step, target);
}

double correlation(std::span<const double> first, std::span<const double> second) {
  const ConstMap a(first.data(), static_cast<Index>(first.size())), b(second.data(), static_cast<Index>(second.size()));
  const Vector from_a = a.array() - a.mean(), from_b = b.array() - b.mean();
  const double norms = from_a.norm() * from_b.norm();
  return norms > 0 ? from_a.dot(from_b) / norms : 0;
}

std::vector<GeneratedMotion> generate_motions(std::span<const TargetSpectrum* const> targets, const GenerateOptions& options) {
  constexpr double most_correlated = 0.16;
  constexpr std::uint64_t attempts = 10;
  std::vector<GeneratedMotion> motions;
  for (const TargetSpectrum* target : targets) {
    double least = std::numeric_limits<double>::infinity();  // up to 1: a motion that may be taken
    GeneratedMotion chosen;
    for (std::uint64_t attempt = 0; attempt < attempts && least > 1; ++attempt) {
      GeneratedMotion drawn = one_motion(*target, options, Draw(options.seed, motions.size(), attempt));
      double worst = shortfall(drawn.fit);
      for (const GeneratedMotion& other : motions)
        worst = std::max(worst, std::abs(correlation(drawn.motion.values, other.motion.values)) / most_correlated);
      if (worst < least) {
        least = worst;
        chosen = std::move(drawn);
      }
    }
    chosen.motion.step = options.step;
    chosen.motion.name = fmt::format("generated {}", motions.size() + 1);
    chosen.motion.format = "generated";
    chosen.motion.unit = "m/s2";
    chosen.motion.processing = {told(options, motions.size(), *target, chosen.fit)};
    motions.push_back(std::move(chosen));
  }
  return motions;
}

}  // namespace uplift
