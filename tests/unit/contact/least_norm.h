#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "uplift/math/dense.h"

// The shortest vector of a product of friction cones that has a given resultant, by Dykstra's alternating projections (J. P. Boyle & R. L.
// Dykstra, Lecture Notes in Statistics 37, 1986): slow, without duals and derivatives, for comparison.
namespace uplift::contact_test {

/// Numbers first ... first + count - 1 of a vector. One: not negative. Two or three: the last is not positive, and the others are together
/// at most `friction` times as long.
struct ConePart {
  Index first = 0;
  int count = 1;
  double friction = 0;
};

inline void project_on_cone(const ConePart& part, Vector& x) {
  if (part.count == 1) {
    x[part.first] = std::max(0.0, x[part.first]);
    return;
  }
  auto tangential = x.segment(part.first, part.count - 1);
  double& normal = x[part.first + part.count - 1];
  const double size = tangential.norm(), mu = part.friction;
  if (size <= -mu * normal) return;
  const double pressure = std::max(0.0, (mu * size - normal) / (1 + mu * mu));
  tangential *= mu * pressure / size;
  normal = -pressure;
}

/// argmin |x|, g x = b, x in the cones; g: resultants x size of x.
inline Vector least_norm(const std::vector<ConePart>& cones, const Matrix& g, const Vector& b, double tolerance = 1e-11) {
  constexpr int most = 100000;
  const Matrix back = CompleteQr(g).solve(Matrix::Identity(g.rows(), g.rows()).eval());
  Vector x = Vector::Zero(g.cols()), correction = x, before = x;
  for (int i = 0; i < most; ++i) {
    before = x;
    x -= back * (g * x - b);
    x += correction;
    correction = x;
    for (const ConePart& cone : cones) project_on_cone(cone, x);
    correction -= x;
    if (i > 0 && (x - before).norm() <= tolerance * x.norm() && (g * x - b).norm() <= 1e3 * tolerance * b.norm()) break;
  }
  return x;
}

}  // namespace uplift::contact_test
