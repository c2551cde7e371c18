#include "uplift/elements/element.h"

namespace uplift {

double Element::axial_force(const Vector&) const {
  return 0;
}

void Element::geometric(double, Matrix& stiffness) const {
  const auto n = unknowns_per_node() * static_cast<Index>(nodes().size());
  stiffness.setZero(n, n);
}

Vec3 Element::first_moment() const {
  return Vec3::Zero();
}

}  // namespace uplift
