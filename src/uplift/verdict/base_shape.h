#pragma once
#include <array>
#include <vector>

#include "uplift/case/case.h"

namespace uplift {

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
