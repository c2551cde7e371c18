#pragma once
#include <optional>

#include "uplift/laws/macro_power_law.h"
#include "uplift/laws/macro_uplift.h"

// What a shallow foundation can bear: bearing capacity f_2, sliding f_1 and their flow (docs/theory/macro_element.md, eqs M5 to M10 and
// M17 to M22).
namespace uplift {

/// Parameters of yielding, as in a geotechnical report.
struct MacroStrength {
  enum class Flow { settling, associated } flow = Flow::settling;
  std::optional<MacroPowerLaw> power_law = {};  // bearing surface; none: that of the effective width (M5). With settling flow only
  double service = 0;                           // V_s: vertical load at which the ground first yields; infinite: no bearing surface [N]
  double ultimate = 0;                          // V_u >= V_s: vertical load that it bears after large settlements [N]
  double reference = 1;                         // w_ref > 0: plastic settlement that brings half of V_u - V_s [m]
  double friction = 0;                          // tan(phi) of the base; infinite: no sliding
  double cohesion = 0;                          // c times the area of the base [N]
  double dilation = 0;                          // tan(psi) of settling flow; associated flow has that of the friction
  double settlement_share = 1;                  // chi of settling flow: > 1 more settlement per rotation
};

/// A yield function or a flow direction at given forces.
struct MacroSurface {
  double value = 0;                            // N; <= 0: elastic
  MacroVector gradient = MacroVector::Zero();  // with respect to the forces
  double by_capacity = 0;                      // d value/d V
};
struct MacroFlow {
  MacroVector direction = MacroVector::Zero();    // plastic displacement per multiplier [m, rad per m]
  MacroMatrix slope = MacroMatrix::Zero();        // d direction/d force
  MacroVector by_capacity = MacroVector::Zero();  // d direction/d V
};

class MacroSurfaces {
 public:
  MacroSurfaces(const MacroElasticity& elasticity, const MacroStrength& strength);
  const MacroStrength& strength() const { return strength_; }

  bool has_bearing() const;
  bool has_sliding() const;
  /// Whether the bearing surface has a value at these forces with N > 0: that of the effective width only for |H| < N.
  bool bears(const MacroVector& force) const;
  /// V = V_s + R(p) of the accumulated plastic settlement p [m], and dV/dp [N/m].
  double capacity(double p) const;
  double hardening(double p) const;

  MacroSurface bearing(const MacroVector& force, double capacity) const;
  /// Its value alone [N].
  double bearing_value(const MacroVector& force, double capacity) const;
  MacroSurface sliding(const MacroVector& force) const;
  MacroFlow bearing_flow(const MacroVector& force, double capacity) const;
  MacroFlow sliding_flow(const MacroVector& force) const;
  /// N over the capacity that H and M leave (eqs M15, M22): 1 on the surface. Infinite where they leave none.
  double bearing_utilisation(const MacroVector& force, double capacity) const;
  /// |H| over the resistance to sliding (eq M16): 1 on the surface. Infinite where there is none.
  double sliding_utilisation(const MacroVector& force) const;

  /// The moment of an axis (0 or 1) [N m] and the shear [N] that alone with N bring the ground to yield, 0 < N < V.
  double largest_moment(int axis, double n, double capacity) const;
  double largest_shear(double n, double capacity) const;

 private:
  struct Reduced;
  struct Product;
  Reduced reduce(const MacroVector& force, double rounding) const;
  MacroPowerLaw::Left left(const MacroVector& force, double capacity) const;
  MacroSurface power_bearing(const MacroVector& force, double capacity) const;
  double moment_share(const MacroVector& force) const;

  bool disc_;
  double length_[2];
  MacroStrength strength_;
  MacroVector ellipsoid_;  // of settling flow: 1/(radius squared) of every force, times V_s
};

}  // namespace uplift
