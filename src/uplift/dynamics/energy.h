#pragma once
#include <vector>

#include "uplift/contact/problem.h"
#include "uplift/model/model.h"

namespace uplift {

/// Energies [J] since the beginning of the first dynamic stage; in static stages before it since the unloaded structure:
///   residual = kinetic + strain + stored + filter + interface_dissipated + plastic + damping + impact + algorithmic + stop - external
///              - (mechanical energy at the beginning)
/// which is zero to round-off for the average acceleration rule with path-averaged tractions. A positive residual is energy that the method
/// created; in static stages the external work is a trapezoidal sum over the load steps, whose error it is.
struct Energies {
  double kinetic = 0, strain = 0, stored = 0, interface_dissipated = 0, damping = 0, impact = 0, external = 0, residual = 0;
  double algorithmic = 0;  // dissipated by the scheme's filters (filtered energy decay)
  double filter = 0;       // stored in them: of order (omega h)^2 of the energy of a motion
  double plastic = 0;      // dissipated by yielding solids; their strain energy is the recoverable one
  double friction = 0;     // under constraints; a part of interface_dissipated
  double stop = 0;         // taken by static stages after dynamic ones, which stop the structure where it is
  /// All that the external work has become, less this work.
  double sum() const {
    return kinetic + strain + stored + filter + interface_dissipated + plastic + damping + impact + algorithmic + stop - external;
  }
};

/// What the interfaces' laws hold and have dissipated [J]; cones hold nothing, and what their friction takes is friction_work().
class InterfaceEnergy {
 public:
  /// Dissipation is summed again only when the memory has changed (for the SDM it costs an exponential per point).
  void update(const std::vector<Block>& blocks, const Vector& opening, const Vector& history);
  double stored = 0, dissipated = 0;

 private:
  Vector last_, density_, lost_;
};

/// What the friction of constraints takes in a step [J]: the work of the mean force on the slip of every point, where it is positive. In
/// the mean the force at the end has the share `end_share`. What a force that turns round in the step gives back stays in the residual;
/// impact_friction.cpp keeps it small.
double friction_work(const std::vector<Block>& blocks, const State& from, const State& to, double end_share);

}  // namespace uplift
