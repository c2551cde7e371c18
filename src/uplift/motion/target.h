#pragma once
#include <memory>
#include <span>
#include <string>

#include "uplift/base/catalog.h"

namespace uplift {

/// A design spectrum: the pseudo-acceleration that an oscillator of one damping ratio shall reach, over its natural frequency.
class TargetSpectrum {
 public:
  virtual ~TargetSpectrum() = default;
  /// Pseudo-acceleration [m/s2] at a frequency > 0 [Hz]; > 0.
  virtual double at(double frequency) const = 0;
  /// What the spectrum comes to at high frequency: the peak ground acceleration [m/s2]; 0 when the target does not say it.
  virtual double peak_ground_acceleration() const = 0;
  /// Damping ratio for which it holds.
  virtual double damping() const = 0;
  /// Frequencies that it was made for [Hz].
  struct Band {
    double from = 0, to = 0;
  };
  virtual Band band() const = 0;
  /// What it is, with its numbers: "Regulatory Guide 1.60, horizontal, pga 2.942 m/s2".
  virtual std::string told() const = 0;
};

std::span<const Entry<TargetSpectrum>* const> target_catalog();
std::span<const PartInfo* const> target_spectra();

}  // namespace uplift
