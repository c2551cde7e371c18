#pragma once
#include <array>
#include <vector>

#include "uplift/case/case.h"

namespace uplift {

/// The pressure of a base as one force: its size, and its size times its place e from the reference point along t1 and t2. In the plane
/// moment_1 is the moment (docs/theory, eq 28).
struct Thrust {
  double force = 0;               // N, compression > 0
  std::array<double, 2> first{};  // N m: P e
};
Thrust thrust_of(Space space, double axial, double moment_1, double moment_2);

/// What the constant loads on all that is connected to the upper side of a base would make of its thrust, if it bore them alone.
struct ConstantLoads {
  Thrust all;
  // The weight: gravity, the parts along it of other loads whose resultant acts downwards, and less the uplift of the water in the base's
  // joint.
  Thrust weight;
  double lateral() const;  // N m: of the others, about the reference point
};
ConstantLoads constant_loads(const BuiltCase& built, std::size_t base);

/// How far a base goes: its convex outline in the plane of its mean normal, about the reference point of its moments.
class BaseShape {
 public:
  BaseShape(const Model& model, const Interface& interface, const InterfaceFacts& facts);
  /// Extent along t1 and t2 [m]; the second is 0 in the plane. Of a rectangle that is turned in space along its sides, the first the one
  /// within 45 degrees of t1.
  std::array<double, 2> width{};
  enum class Outline { other, rectangle, round } outline = Outline::other;  // round: at least 12 corners on a circle
  /// Place of the thrust over the width: of a round base |e|/D in all directions, of others the larger magnitude of e/B along both axes.
  double eccentricity(const Thrust& thrust) const;
  /// Place of the thrust over the width, e/B, along the directions of `width`.
  double eccentricity(const Thrust& thrust, std::size_t axis) const;
  /// Stabilising over driving moment about the toe, the least of all edges (docs/theory, eq 29); infinite when nothing drives.
  double overturning_safety(const Thrust& stabilises, const Thrust& now) const;

 private:
  struct Edge {
    std::array<double, 2> out{};  // unit, outwards
    double distance = 0;          // m
  };
  std::vector<Edge> edges_;
  double along(const std::array<double, 2>& vector, std::size_t axis) const;  // component in the direction of width[axis]
  std::array<double, 2> first_{1, 0};  // direction of width[0]; the other one is at right angles, counter-clockwise
};

}  // namespace uplift
