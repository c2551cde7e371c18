#pragma once
#include <memory>
#include <string>
#include <vector>

#include "uplift/laws/law.h"
#include "uplift/math/linalg.h"

namespace uplift {

/// The points of one interface and how they see the structure: opening = B u + gap. Rows of B and of every interface vector are
/// component-major with the normal last, as in `Batch`. The normal n points from the lower side L (soil) to the upper side U (structure).
struct Interface {
  std::string name;
  Batch batch;                              // points, components
  std::vector<Vec2> position;               // m
  std::vector<Vec2> normal;                 // unit
  Vector area;                              // m2 per point: quadrature weight x det J x thickness
  Vector gap;                               // m per row: initial gap in the normal component, 0 in the tangential ones
  Sparse b;                                 // (points x components) x free unknowns
  Vec2 reference = Vec2::Zero();            // m: point about which the resultant moment is taken
  std::unique_ptr<const InterfaceLaw> law;  // one of the two
  std::unique_ptr<const Cone> cone;
  std::string behaviour;  // name of the law or cone
  int rows() const { return batch.points * batch.components; }
};

/// Tangent of a normal: n turned by -90 degrees, so that (t, n) is right-handed; n = (0, 1) gives t = (1, 0).
inline Vec2 tangent(const Vec2& normal) {
  return {normal.y(), -normal.x()};
}

/// What the upper side exerts on the lower one, in the axes of the mean normal: axial force N [N] (tension > 0), shear V [N] along +t,
/// moment M [N m] about the reference point, counter-clockwise. A wind to the right on a tower gives V > 0, M < 0.
struct Resultant {
  double axial = 0, shear = 0, moment = 0;
};
/// `force` holds one force per row of the interface [N], tension > 0.
Resultant resultant(const Interface&, const double* force);
/// Share of the interface's area whose gap is larger than `tolerance` [m]: counted by gap, never by zero pressure.
double uplifted_ratio(const Interface&, const double* opening, double tolerance);

}  // namespace uplift
