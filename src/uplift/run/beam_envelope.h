#pragma once
#include <memory>
#include <string>
#include <vector>

#include "uplift/elements/space.h"

namespace uplift {

class ForceQuantity;

/// Beams whose section forces are watched at every step.
struct EnvelopeRequest {
  std::string beam;
  std::vector<std::string> components;  // "axial", "shear", ...
  struct Section {
    double along = 0;  // m, from the beginning of the line
    Place position;    // m
  };
  std::vector<Section> sections;
  std::vector<std::shared_ptr<const ForceQuantity>> forces;  // components of the first section, of the second, ...
};

/// Largest and smallest value of a force, with their sign, and when [s].
struct ForceRange {
  double most = 0, most_time = 0, least = 0, least_time = 0;
  bool met = false;
  void add(double value, double time) {
    if (!met || value > most) most = value, most_time = time;
    if (!met || value < least) least = value, least_time = time;
    met = true;
  }
};

/// Section forces along a beam: their ranges over all steps of the dynamic stages, the state at their beginning included.
struct BeamEnvelope {
  std::string beam;
  std::vector<std::string> components;
  std::vector<EnvelopeRequest::Section> sections;
  std::vector<ForceRange> ranges;  // in the order of EnvelopeRequest::forces
  const ForceRange& at(std::size_t section, std::size_t component) const { return ranges[section * components.size() + component]; }
};

}  // namespace uplift
