#include "uplift/elements/element.h"

namespace uplift {

double Element::axial_force(const Vector&) const {
  return 0;
}

void Element::geometric(double, Matrix& stiffness) const {
  const auto n = static_cast<Index>(dofs_per_node * nodes().size());
  stiffness.setZero(n, n);
}

Vec2 Element::first_moment() const {
  return Vec2::Zero();
}

}  // namespace uplift
