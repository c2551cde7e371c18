#pragma once
#include <functional>
#include <memory>

#include "uplift/laws/law.h"

namespace uplift {

/// One step of all points of an interface, as the caller of the library writes it; see `uplift_law_function` in include/uplift.h for the
/// layout and for what the energies must satisfy. False: the run fails.
struct ExternalStep {
  int points, components;
  double step;
  const double *from, *to, *old;
  double *traction, *slope, *memory, *stored, *dissipated;
};
using ExternalFunction = std::function<bool(const ExternalStep&)>;

/// What the case says of a law of type `external`.
struct ExternalLawInfo {
  std::string name;
  int memory = 0;                   // variables of a point
  double stiffness = 0, shear = 0;  // Pa/m, of the closed joint
};
bool is_external(const Values& behaviour);
ExternalLawInfo external_info(const Values& behaviour);

/// The law with its function. Its path-averaged traction is the discrete gradient of the sum E of both energies (Gonzalez 1996):
///     mean = t_m + (E_1 - E_0 - t_m . d) / |d|^2 d        d = to - from, t_m: traction at the midpoint of the path
/// so that the energy balance of the step closes whatever the traction is between the two ends.
std::unique_ptr<const InterfaceLaw> external_law(const ExternalLawInfo& info, ExternalFunction function);

}  // namespace uplift
