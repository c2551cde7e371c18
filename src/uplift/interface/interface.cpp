#include "uplift/interface/interface.h"

namespace uplift {

Resultant resultant(const Interface& interface, const double* force) {
  const int points = interface.batch.points, normal_row = interface.batch.normal();
  Vec2 total = Vec2::Zero(), mean_normal = Vec2::Zero();
  double moment = 0;
  for (int i = 0; i < points; ++i) {
    const Vec2& n = interface.normal[i];
    Vec2 p = force[normal_row + i] * n;
    if (interface.batch.components == 2) p += force[i] * tangent(n);
    const Vec2 arm = interface.position[i] - interface.reference;
    total += p;
    moment += arm.x() * p.y() - arm.y() * p.x();
    mean_normal += interface.area[i] * n;
  }
  // a closed ring has no mean normal: it is then reported in the axes of its first point
  const double scale = interface.area.sum();
  const Vec2 n = mean_normal.norm() > 1e-9 * scale ? mean_normal.normalized() : interface.normal[0];
  return {.axial = total.dot(n), .shear = total.dot(tangent(n)), .moment = moment};
}

double uplifted_ratio(const Interface& interface, const double* opening, double tolerance) {
  const double* normal_opening = opening + interface.batch.normal();
  double open = 0;
  for (int i = 0; i < interface.batch.points; ++i)
    if (normal_opening[i] > tolerance) open += interface.area[i];
  return open / interface.area.sum();
}

}  // namespace uplift
