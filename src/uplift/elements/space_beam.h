#pragma once
#include <array>
#include <limits>
#include <optional>

#include "uplift/elements/beam.h"
#include "uplift/math/fixed.h"

namespace uplift {

/// Section of a beam in space, constant over its length, in its principal axes y and z.
struct SpaceBeamSection {
  double bending_y = 0, bending_z = 0;                       // E I_y, E I_z [N m2], > 0: moments about y and z
  double torsion = 0;                                        // G J [N m2], > 0
  std::optional<double> axial;                               // E A [N]; absent: inextensible, as in BeamSection
  double shear_y = std::numeric_limits<double>::infinity();  // G A_y [N]: shear force along y; infinite: Euler-Bernoulli
  double shear_z = std::numeric_limits<double>::infinity();  // G A_z [N]: along z
  double mass_per_length = 0;                                // rho A [kg/m]
  double rotary_y = 0, rotary_z = 0;                         // rho I_y, rho I_z [kg m]: rotary inertia in bending; 0 leaves it out
  std::optional<double> polar;                               // rho I_p [kg m]: rotary inertia in torsion; absent: rho I_y + rho I_z
  BeamSection::Mass mass = BeamSection::Mass::none;
};

/// Local axes of a beam as rows x, y, z: x = `along`, z in the half-plane of x and `up` on the side of `up` (the vector in the x-z plane,
/// vecxz, of OpenSees), y = z cross x. So the local z of a horizontal beam with the default points upwards and E I_y resists its weight.
/// Default of `up`: global z; for a beam along global z (sine of the angle below 1e-3, as in SAP2000) global x.
/// Empty when `along` is zero or `up` is parallel to it (sine below 1e-6).
std::optional<Mat3> beam_axes(const Vec3& along, const std::optional<Vec3>& up);

/// Straight beam with two nodes in space, unknowns (ux, uy, uz [m], rx, ry, rz [rad], right-handed) at a and b, in global axes. In local
/// axes it is the plane beam (elements/beam.h) twice, in the planes x-y and x-z, with its stiffness, masses and geometric stiffness:
///   u_y, r_z with E I_z, G A_y, rho I_z;     u_z, -r_y with E I_y, G A_z, rho I_y     (r_y = -du_z/dx without shear);
/// and a bar in torsion: G J/L [1, -1], consistent mass rho I_p L/6 [2, 1], lumped rho I_p L/2. Torsion is that of Saint-Venant, the shear
/// centre is the centroid. The geometric stiffness is that of an axial force in bending; an axial force does not soften torsion.
class SpaceBeam : public Element {
 public:
  /// Positions in m; they must not coincide. `up` as for beam_axes, which must not be empty.
  SpaceBeam(int a, int b, const Vec3& position_a, const Vec3& position_b, const SpaceBeamSection& section,
            const std::optional<Vec3>& up = std::nullopt);
  std::span<const int> nodes() const override { return nodes_; }
  int unknowns_per_node() const override { return 6; }
  void form(Local local) const override;
  double axial_force(const Vector& displacement) const override;
  void geometric(double axial, Matrix& stiffness) const override;

  double length() const { return xy_.length(); }
  bool has_axis() const override { return true; }
  bool inextensible() const override { return xy_.inextensible(); }
  Mat3 axes() const override { return axes_; }
  /// End forces (fx, fy, fz, mx, my, mz at a and b) [N, N m] in local axes for global end displacements.
  Vector end_forces(const Vector& displacement) const;
  SectionRows section(double xi) const override;

 private:
  Vector to_local(const Vector& global) const;
  Matrix local_stiffness() const;
  Matrix local_mass() const;

  std::array<int, 2> nodes_;
  Mat3 axes_;
  Beam xy_, xz_;          // the beams of the two planes in their local axes; the axial parts are those of xy_
  double torsion_;        // G J/L [N m]
  double polar_inertia_;  // rho I_p L [kg m2]
  BeamSection::Mass mass_;
};

}  // namespace uplift
