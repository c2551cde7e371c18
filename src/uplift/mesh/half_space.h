#pragma once
#include "uplift/math/linalg.h"

namespace uplift {

/// The points x with normal . x <= level.
struct HalfSpace {
  Vec3 normal = Vec3::Zero();  // unit
  double level = 0;            // m
  double distance(const Vec3& x) const { return normal.dot(x) - level; }
  HalfSpace other_side() const { return {-normal, -level}; }
};

/// Where the line between two points meets a plane, from their distances to it, which have opposite signs.
inline Vec3 crossing(const Vec3& a, double at_a, const Vec3& b, double at_b) {
  return a + at_a / (at_a - at_b) * (b - a);
}

}  // namespace uplift
