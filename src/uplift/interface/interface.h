#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "uplift/elements/space.h"
#include "uplift/laws/foundation.h"

namespace uplift {

/// The points of one interface and how they see the structure: opening = B u + gap. Rows of B and of every interface vector are
/// component-major with the normal last, as in `Batch`. The normal n points from the lower side L (soil) to the upper side U (structure).
struct Interface {
  std::string name;
  Batch batch;  // points, components
  Space space;
  std::vector<Place> position;              // m
  std::vector<Place> normal;                // unit
  Vector area;                              // m2 per point: quadrature weight x det J x thickness
  Vector weight;                            // m2 per point: area x relative stiffness of the ground; force = weight x traction of the law
  Vector gap;                               // m per row: initial gap in the normal component, 0 in the tangential ones
  Sparse b;                                 // (points x components) x free unknowns
  Place reference;                          // m: point about which the resultant moment is taken
  std::unique_ptr<const InterfaceLaw> law;  // one of the two
  std::unique_ptr<const Cone> cone;
  std::string behaviour;               // name of the law or cone
  std::optional<Footprint> footprint;  // of a whole foundation: one point with rotations, area 1
  int rows() const { return batch.points * batch.components; }
};

/// Local axes of a normal n: tangents first, the normal last (number space.dimension - 1).
/// Plane: t is n turned by -90 degrees; n = (0, 1) gives t = (1, 0). Space: t1 is the x axis projected on the face (the y axis where n is
/// within 26 degrees of x), t2 = n x t1; n = (0, 0, 1) gives t1 = x, t2 = y.
Vec3 local_axis(Space space, const Vec3& normal, int axis);
/// In space: the same axes turned about the normal by `azimuth` [rad].
Vec3 turned_axis(const Vec3& normal, double azimuth, int axis);
/// Along what a component of a point moves, or about what it turns.
struct ComponentAxis {
  Vec3 axis;
  bool rotation = false;
};
/// The local axes of the point's normal; under a whole foundation turned by its azimuth.
ComponentAxis component_axis(const Interface&, int point, int component);
/// Direction of the area-weighted mean of the normals; the vertical axis where this mean is shorter than 1/2, as of the walls of a pit.
Vec3 mean_normal(const Interface&);

/// What the upper side exerts on the lower one, in the axes of the mean normal: axial force N [N] (tension > 0), shear V [N] along +t,
/// moment M [N m] about the reference point, counter-clockwise. A wind to the right on a tower gives V > 0, M < 0.
/// In space: shear along t1 and t2, moments about t1, t2 and the normal; `shear` and `moment` are the lengths of (1, 2).
struct Resultant {
  double axial = 0, shear = 0, moment = 0;
  double shear_1 = 0, shear_2 = 0, moment_1 = 0, moment_2 = 0, torsion = 0;
};
/// `force` holds one force per row of the interface [N], tension > 0.
Resultant resultant(const Interface&, const double* force);
/// The linear part of it, one column per row of the interface. Rows in the plane: V, N, M; in space: V1, V2, N, M1, M2, torsion.
Matrix resultant_rows(const Interface&);
/// From what these rows give.
Resultant resultant_of(Space space, const double* sums);
/// Share of the interface's area whose gap is larger than `tolerance` [m]: counted by gap, never by zero pressure.
double uplifted_ratio(const Interface&, const double* opening, double tolerance);

}  // namespace uplift
