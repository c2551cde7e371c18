#pragma once
#include <array>
#include <limits>
#include <optional>

#include "uplift/elements/element.h"

namespace uplift {

/// Section of a plane beam, constant over its length.
struct BeamSection {
  double bending = 0;           // E I [N m2], > 0
  std::optional<double> axial;  // E A [N]; absent: inextensible, the axial stiffness is zero and the model builder gets inextensible(a, b)
  double shear = std::numeric_limits<double>::infinity();  // G A_s [N]; infinite: Euler-Bernoulli
  double mass_per_length = 0;                              // rho A [kg/m]
  double rotary_per_length = 0;                            // rho I [kg m]: rotary inertia; 0 leaves it out
  enum class Mass { none, consistent, lumped } mass = Mass::none;
  /// phi = 12 E I / (G A_s L^2): ratio of shear to bending flexibility; 0 for Euler-Bernoulli.
  double shear_ratio(double length) const { return 12 * bending / (shear * length * length); }
};

/// Plane beam with two nodes, exact in statics for end loads (Euler-Bernoulli and Timoshenko: Przemieniecki 1968, sections 5.6 and 11.4).
///
/// In local axes (x from a to b, y to the left of it), with phi of BeamSection and EI' = EI / (1 + phi):
///   shear row     EI'/L^3 [12, 6L, -12, 6L],   moment row   EI'/L^3 [6L, (4 + phi) L^2, -6L, (2 - phi) L^2]
///   axial         EA/L [1, -1]
/// Consistent mass: integral of rho A N^T N + rho I P^T P with the exact static shapes (N deflection, P rotation), linear along the axis.
/// Frequencies converge with h^4 from above without shear flexibility, with h^2 where it counts (the shear force is constant in an
/// element). Lumped mass: half of rho A L at each end, half of rho I L as rotary inertia. Geometric stiffness, consistent: N integral of
/// (dN/dx)^T (dN/dx); for phi = 0 it is N/(30L) [36, 3L, -36, 3L; 3L, 4L^2, -3L, -L^2; ...].
class Beam : public Element {
 public:
  /// Positions in m; they must not coincide.
  Beam(int a, int b, Vec2 position_a, Vec2 position_b, BeamSection section);
  std::span<const int> nodes() const override { return nodes_; }
  int unknowns_per_node() const override { return 3; }
  void form(Local local) const override;
  double axial_force(const Vector& displacement) const override;
  void geometric(double axial, Matrix& stiffness) const override;

  double length() const { return length_; }
  bool has_axis() const override { return true; }
  bool inextensible() const override { return !section_.axial; }
  Mat3 axes() const override;
  /// End forces (fx, fy, m at a and b) [N, N, N m] in local axes for global end displacements.
  Vector end_forces(const Vector& displacement) const;
  /// Equilibrium of the part from a to the section: end forces and the inertia between.
  SectionRows section(double xi) const override;

 private:
  Matrix local_stiffness() const;
  Matrix local_mass() const;
  Matrix local_geometric() const;
  Matrix inertia_before(double xi) const;
  Matrix to_global(const Matrix& local) const;

  std::array<int, 2> nodes_;
  BeamSection section_;
  double length_;
  Matrix axes_;  // 6 x 6: local = axes * global
};

}  // namespace uplift
