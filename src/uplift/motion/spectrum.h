#pragma once
#include <span>
#include <vector>

#include "uplift/motion/motion.h"

namespace uplift {

/// Largest responses of damped oscillators to one motion, over their natural frequencies.
struct Spectrum {
  /// Pseudo-acceleration w2 SD [m/s2], absolute acceleration [m/s2], relative velocity [m/s], relative displacement [m].
  enum class Kind { psa, sa, sv, sd } kind = Kind::psa;
  double damping = 0.05;            // ratio to the critical damping
  std::vector<double> frequencies;  // Hz, ascending
  std::vector<double> values;
};

/// Where the largest response is looked for. At the points: those of the record, and sub-steps between them so that a period has twenty at
/// least; the usual definition, up to 1.2 % below the peak of a vibration. Between: also between these, by the cubic through values and
/// rates; within 1e-4 of the true peak, however finely the same motion is sampled.
enum class Peaks { at_points, between };

/// One spectrum for every damping ratio (0 <= ratio < 1), in their order. Exact for an acceleration [m/s2] that is straight between its
/// points at equal steps [s] (Nigam and Jennings 1969); from rest at t = 0 until the last point. Frequencies are > 0, in any order.
/// Threads: 0: as many as there are cores; the result does not depend on them.
std::vector<Spectrum> response_spectra(std::span<const double> acceleration, double step, const std::vector<double>& frequencies,
                                       const std::vector<double>& dampings, Spectrum::Kind kind, int threads = 0,
                                       Peaks peaks = Peaks::at_points);

/// Spectra of two horizontal components over all directions in the plane (Boore 2010, orientation-independent, period by period).
struct RotatedSpectra {
  Spectrum median, largest;               // RotD50, RotD100
  std::vector<double> largest_direction;  // rad, from the first component towards the second, 0 <= angle < pi
};
/// Both components have the same step and length; directions one degree apart, peaks at the points and sub-steps.
RotatedSpectra rotated_spectra(std::span<const double> first, std::span<const double> second, double step,
                               const std::vector<double>& frequencies, double damping, Spectrum::Kind kind, int threads = 0);

/// The 75 frequencies of Regulatory Guide 1.122, table 1 (0.2 to 34 Hz) [Hz].
std::vector<double> rg_1_122_frequencies();
/// `count` frequencies from one to the other, equally spaced in their logarithm [Hz]; two at least.
std::vector<double> log_spaced(double from, double to, int count);

/// Broadened by `share` to either side (0.15: +-15 %), 0 <= share < 1: flat over every peak, sides parallel to those of the raw curve in
/// logarithms, never below it. At the frequencies of the raw curve and wherever the broadened one has a corner, within the same range.
Spectrum broadened(const Spectrum& raw, double share);
/// The largest value at every frequency; all have the same frequencies.
Spectrum envelope(std::span<const Spectrum> spectra);
/// Value at a frequency [Hz]: straight in logarithms between the points, constant outside.
double value_at(const Spectrum& spectrum, double frequency);

}  // namespace uplift
