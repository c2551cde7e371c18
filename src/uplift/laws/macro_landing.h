#pragma once
#include <cmath>
#include <optional>

#include "uplift/laws/macro_return.h"

// A footing that touches the ground with an edge or a corner, with next to no load (docs/theory/macro_element.md, eqs M23 to M25).
namespace uplift {

/// Its path along the settling flow for N -> 0. All arguments must outlive it.
class MacroLanding {
 public:
  /// `trial` touches the ground; `settlement`: p at the beginning [m].
  MacroLanding(const MacroUplift& uplift, const MacroSurfaces& surfaces, const MacroVector& trial, double settlement);

  /// So far along the flow that the ground just bears the contact, with the moment of a flat axis and the shear that the flow has; none
  /// where the ground bears the trial state, or nothing on the path.
  std::optional<MacroVector> borne() const;
  /// A footing that comes down where the contact, however small, is pressed beyond its bearing capacity: it sinks in without load as far as
  /// it touches the ground. False: the ground bears it before.
  bool land(MacroReturned& out) const;

 private:
  void follow_flow();
  double capacity(const MacroVector& e) const { return surfaces_.capacity(settlement_ + std::abs(trial_[macro_n] - e[macro_n])); }
  MacroVector sunk(double multiplier) const;
  double shear_share(double multiplier) const;
  double flat_moment(double multiplier, int axis) const;
  bool beyond(double multiplier) const;
  MacroVector pressed(double multiplier) const;
  bool overloaded(double multiplier) const;

  const MacroUplift& uplift_;
  const MacroSurfaces& surfaces_;
  const MacroVector& trial_;
  double settlement_;
  MacroVector toe_ = MacroVector::Zero();  // d toe/d displacement, which is M/N; zero for an axis that has come to lie flat
  MacroVector flow_;                       // its direction, that of |H| = N included
  double most_ = 0;                        // the multiplier that takes the toe out of the ground
  double largest_shear_;                   // H/N
};

}  // namespace uplift
