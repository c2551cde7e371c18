#pragma once
#include <span>
#include <vector>

namespace uplift {

/// Largest responses of damped oscillators to one motion, over their natural frequencies.
struct Spectrum {
  /// Pseudo-acceleration w2 SD [m/s2], absolute acceleration [m/s2], relative velocity [m/s], relative displacement [m].
  enum class Kind { psa, sa, sv, sd } kind = Kind::psa;
  double damping = 0.05;            // ratio to the critical damping
  std::vector<double> frequencies;  // Hz, ascending
  std::vector<double> values;
};

/// One spectrum for every damping ratio, in their order. Exact for an acceleration [m/s2] that is straight between its points at equal
/// steps [s]; peaks between the points are found by sub-steps where the period is short against the step (Nigam and Jennings 1969).
/// Threads: 0: as many as there are cores; the result does not depend on them.
std::vector<Spectrum> response_spectra(std::span<const double> acceleration, double step, const std::vector<double>& frequencies,
                                       const std::vector<double>& dampings, Spectrum::Kind kind, int threads = 0);

/// The 75 frequencies of Regulatory Guide 1.122, table 1 (0.2 to 34 Hz) [Hz].
std::vector<double> rg_1_122_frequencies();
/// `count` frequencies from one to the other, equally spaced in their logarithm [Hz].
std::vector<double> log_spaced(double from, double to, int count);

/// Broadened by `share` to either side (0.15: +-15 %): flat over every peak, sides parallel to those of the raw curve, never below it.
Spectrum broadened(const Spectrum& raw, double share);
/// The largest value at every frequency; all have the same frequencies.
Spectrum envelope(std::span<const Spectrum> spectra);
/// Value at a frequency [Hz]: straight in logarithms between the points, constant outside.
double value_at(const Spectrum& spectrum, double frequency);

}  // namespace uplift
