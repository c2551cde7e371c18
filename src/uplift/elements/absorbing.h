#pragma once
#include "uplift/elements/element_entry.h"

namespace uplift {

struct AbsorbingSection {
  ElasticMaterial material;  // of the soil behind the face; rho > 0
  double thickness = 1;      // m, faces of plane models only
  bool lumped = false;       // diagonal matrix
};

/// Of the table [[absorbing]]; InputError where the ground beside cannot carry waves.
AbsorbingSection absorbing_ground(const Values& absorbing, const FillingBeside& beside, Space space);

/// Viscous boundary (Lysmer & Kuhlemeyer, J. Eng. Mech. Div. ASCE 95 (1969) 859-877): the soil beyond a face answers the velocity v with
/// the traction
///   t = -(rho Vp (n . v) n + rho Vs (v - (n . v) n)),
/// exact for plane waves that leave along the normal n. At an angle a part comes back: of the energy of a P wave 0.03 % at 30 degrees, 0.4
/// % at 45, 3.6 % at 60 (nu = 0.25). As a damping matrix
///   C = int N^T (rho Vp n n^T + rho Vs (I - n n^T)) N dA     on line2/3 (plane strain), tri3/6 and quad4/8/9 faces.
/// Consistent by default. Lumped: row sums, for tri6 and quad8 the diagonal scaled to the whole area (their row sums are zero or negative
/// at the corners); with those two a uniform wave is met in the mean only, so consistent is better there. The sign of n does not matter.
class AbsorbingFace : public Element {
 public:
  AbsorbingFace(Cell cell, std::span<const int> nodes, Coordinates coordinates, AbsorbingSection section, const CellRule* part = nullptr);
  std::span<const int> nodes() const override { return nodes_; }
  int unknowns_per_node() const override { return dimension_; }
  void form(Local local) const override;

  double area() const;  // m2
  /// Nodal forces per rate [N per m/s] of an incoming wave whose particles move along `motion` (dimensionless, as a rule a unit vector):
  /// 2 rho c A spread by the same areas as C, that is 2 C (motion at every node). Times the velocity of the incoming wave alone it drives
  /// the boundary; a free surface above then moves twice as much (Joyner & Chen, BSSA 65 (1975) 1315-1336).
  Vector incident(const Vec3& motion) const;

 private:
  Matrix damping() const;

  Cell cell_;
  int dimension_;
  std::vector<int> nodes_;
  Coordinates coordinates_;
  AbsorbingSection section_;
  CellRule rule_;
};

/// Waves that come up vertically: compression, shear in the plane of the azimuth, shear across it.
enum class Wave { p, sv, sh };
/// Unit particle motion. Plane models (y up): P (0,1), SV (1,0); they have no SH (assertion). In three dimensions (z up): P (0,0,1), SV
/// (cos a, sin a, 0), SH
/// (-sin a, cos a, 0) with the azimuth a [rad] counter-clockwise from x.
Vec3 wave_motion(Wave wave, int dimension, double azimuth = 0);

}  // namespace uplift
