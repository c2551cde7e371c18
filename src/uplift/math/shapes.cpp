#include "uplift/math/shapes.h"

#include <cassert>

namespace uplift {

LineShape line_shape(int nodes, double xi) {
  assert(nodes == 2 || nodes == 3);
  LineShape shape{Vector(nodes), Vector(nodes)};
  if (nodes == 2) {
    shape.value << (1 - xi) / 2, (1 + xi) / 2;
    shape.slope << -0.5, 0.5;
  } else {
    shape.value << xi * (xi - 1) / 2, 1 - xi * xi, xi * (xi + 1) / 2;
    shape.slope << xi - 0.5, -2 * xi, xi + 0.5;
  }
  return shape;
}

BeamShape beam_shape(double xi, double length, double phi) {
  const double l = length, x = xi, x2 = xi * xi, x3 = x2 * xi, c = 1 / (1 + phi);
  BeamShape shape;
  shape.deflection << 1 - 3 * x2 + 2 * x3 + phi * (1 - x), l * (x - 2 * x2 + x3 + phi * (x - x2) / 2), 3 * x2 - 2 * x3 + phi * x,
      l * (x3 - x2 - phi * (x - x2) / 2);
  shape.slope << (-6 * x + 6 * x2 - phi) / l, 1 - 4 * x + 3 * x2 + phi * (1 - 2 * x) / 2, (6 * x - 6 * x2 + phi) / l,
      3 * x2 - 2 * x - phi * (1 - 2 * x) / 2;
  shape.rotation << 6 * (x2 - x) / l, 1 - 4 * x + 3 * x2 + phi * (1 - x), 6 * (x - x2) / l, 3 * x2 - 2 * x + phi * x;
  shape.deflection *= c;
  shape.slope *= c;
  shape.rotation *= c;
  return shape;
}

}  // namespace uplift
