#include "uplift/motion/intensity.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "uplift/motion/formats/convert.h"
#include "uplift/motion/spectrum.h"

// Arias, in Seismic Design for Nuclear Power Plants (1970); Housner, Behavior of structures during earthquakes (1959); CAV: EPRI NP-5930
// (1988). All of an acceleration that is straight between its points, so that every integral over a step has a closed form.
namespace uplift {

namespace {

constexpr double arias_factor = std::numbers::pi / (2 * standard_gravity);

/// Integral of a2 from the beginning of a step to the time s within it, a = start + slope s.
double energy_within(double start, double slope, double s) {
  return s * (start * start + start * slope * s + slope * slope * s * s / 3);
}

/// Integral of |a| over one step.
double area_of(double from, double to, double h) {
  const double p = std::abs(from), q = std::abs(to);
  return from * to >= 0 ? h * (p + q) / 2 : h * (p * p + q * q) / (2 * (p + q));
}

double cav_of(const Motion& motion) {
  double sum = 0;
  for (std::size_t i = 1; i < motion.values.size(); ++i) sum += area_of(motion.values[i - 1], motion.values[i], motion.step);
  return sum;
}

/// Largest |velocity| within a step: at its end, or where the acceleration passes zero.
double velocity_peak(double v, double from, double to, double h) {
  const double end = std::abs(v + h * (from + to) / 2);
  return from * to < 0 ? std::max(end, std::abs(v + from * h * from / (from - to) / 2)) : end;
}

/// Largest |displacement| within a step: at its end, or where the velocity v + from s + slope s2/2 passes zero.
double displacement_peak(double u, double v, double from, double to, double h) {
  const double slope = (to - from) / h;
  const auto at = [&](double s) { return std::abs(u + s * (v + s * (from / 2 + s * slope / 6))); };
  double peak = at(h);
  const double root = from * from - 2 * slope * v;
  if (root < 0) return peak;
  const double q = -(from + std::copysign(std::sqrt(root), from));  // the stable pair of roots: q/slope, 2 v/q
  for (const double s : {q / slope, 2 * v / q})
    if (s > 0 && s < h) peak = std::max(peak, at(s));
  return peak;
}

void add_peaks(const Motion& motion, Intensity& intensity) {
  const Integrals path = integrals_of(motion.values, motion.step);
  for (std::size_t i = 1; i < motion.values.size(); ++i) {
    const double from = motion.values[i - 1], to = motion.values[i], v = path.velocity[i - 1];
    intensity.pgv = std::max(intensity.pgv, velocity_peak(v, from, to, motion.step));
    intensity.pgd = std::max(intensity.pgd, displacement_peak(path.displacement[i - 1], v, from, to, motion.step));
  }
}

/// Integral of the pseudo-velocity over the periods from 0.1 s to 2.5 s, straight between periods 0.01 s apart.
double housner_of(const Motion& motion) {
  constexpr int count = 240;
  constexpr double first = 0.1, gap = 0.01;
  std::vector<double> frequencies;
  for (int i = count; i >= 0; --i) frequencies.push_back(1 / (first + gap * i));
  const Spectrum spectrum = response_spectra(motion.values, motion.step, frequencies, {0.05}, Spectrum::Kind::psa).front();
  double sum = 0;
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    const double velocity = spectrum.values[i] / (2 * std::numbers::pi * frequencies[i]);
    sum += (i == 0 || i == count ? 0.5 : 1.0) * gap * velocity;
  }
  return sum;
}

}  // namespace

std::vector<double> husid(const Motion& motion) {
  std::vector<double> sum(motion.values.size());
  for (std::size_t i = 1; i < sum.size(); ++i) {
    const double slope = (motion.values[i] - motion.values[i - 1]) / motion.step;
    sum[i] = sum[i - 1] + arias_factor * energy_within(motion.values[i - 1], slope, motion.step);
  }
  return sum;
}

double arias_time(const Motion& motion, double share) {
  const std::vector<double> sum = husid(motion);
  const double wanted = share * sum.back();
  const auto reached = std::ranges::lower_bound(sum, wanted);
  const auto i = static_cast<std::size_t>(reached - sum.begin());
  if (i == 0 || sum.back() == 0) return 0;
  const double slope = (motion.values[i] - motion.values[i - 1]) / motion.step;
  double low = 0, high = motion.step;  // the cubic is monotone: halving finds its root to the last digit
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = (low + high) / 2;
    (sum[i - 1] + arias_factor * energy_within(motion.values[i - 1], slope, middle) < wanted ? low : high) = middle;
  }
  return motion.step * static_cast<double>(i - 1) + high;
}

Intensity intensity_of(const Motion& motion) {
  assert(motion.kind == MotionKind::acceleration && motion.values.size() >= 2);
  Intensity intensity;
  intensity.pga = std::abs(peak_of(motion).value);
  if (intensity.pga == 0) return intensity;
  add_peaks(motion, intensity);
  intensity.arias = husid(motion).back();
  intensity.cav = cav_of(motion);
  intensity.d5 = arias_time(motion, 0.05);
  intensity.d95 = arias_time(motion, 0.95);
  intensity.housner = housner_of(motion);
  return intensity;
}

}  // namespace uplift
