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

}  // namespace uplift
