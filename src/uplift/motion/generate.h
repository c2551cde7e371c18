#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "uplift/base/declare.h"
#include "uplift/motion/motion.h"
#include "uplift/motion/target.h"

namespace uplift {

/// How the strength of a generated motion grows and fades, between 0 and 1.
struct Envelope {
  /// trapezoid: straight lines. jennings: (t/rise)2, 1, exp(-c (t - fall)), 0.05 at the end (Jennings, Housner and Tsai 1968).
  /// saragoni_hart: t^b exp(-c t), 1 at `rise`, 0.05 at the end (Saragoni and Hart 1974); it has no `fall`.
  enum class Shape { trapezoid, jennings, saragoni_hart } shape = Shape::jennings;
  double rise = 3, fall = 12;  // s, 0 < rise <= fall < duration

  double at(double time, double duration) const;
};

std::string_view to_string(Envelope::Shape);

struct GenerateOptions {
  double duration = 20;  // s, whole steps
  double step = 0.005;   // s
  std::uint64_t seed = 1;
  Envelope envelope;
  double from = 0.2, to = 33;  // Hz: the band of the fit
};
/// Keys of a case file or of a command line for these options, and the options from their checked values. Throws InputError where they
/// contradict each other, or the target.
const Section& generate_section();
GenerateOptions generate_options(const Values& values, const TargetSpectrum& target);

/// How well a motion has the spectrum that it was made for: at 1000 frequencies per decade over the band, and twice as many where the
/// damping is small (below 2 %).
struct SpectrumFit {
  double damping = 0;
  std::vector<double> frequencies, target, reached;  // Hz, m/s2
  double mean_error = 0;                             // mean of |reached/target - 1|
  double largest_error = 0;                          // largest of it
  double least_ratio = 0;                            // smallest of reached/target
  double mean_ratio = 0;                             // mean of reached/target
  /// Mean error at most 5 %, nowhere below 90 % of the target.
  bool good() const;
};
SpectrumFit spectrum_fit(std::span<const double> acceleration, double step, const TargetSpectrum& target, double from, double to);

struct GeneratedMotion {
  Motion motion;  // an acceleration; its integrals end at rest at zero displacement
  SpectrumFit fit;
  int iterations = 0;
};

/// One motion for every target, statistically independent of each other: the magnitude of the correlation coefficient of any two is at most
/// 0.16 (US NRC Standard Review Plan 3.7.1). What is too much alike or does not fit is drawn again, up to ten times; the best is returned
/// in any case. A motion depends on the options, its target and those before it alone: no clock, no library's distribution of random
/// numbers, no number of threads; its values are rounded to 1e-5 m/s2, far above the round-off of the fit, so that other processors and
/// compilers give the same.
std::vector<GeneratedMotion> generate_motions(std::span<const TargetSpectrum* const> targets, const GenerateOptions& options);

/// Correlation coefficient of two accelerations of the same length about their means, -1 to 1; 0 when one of them is constant.
double correlation(std::span<const double> first, std::span<const double> second);

}  // namespace uplift
