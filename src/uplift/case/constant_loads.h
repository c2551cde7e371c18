#pragma once
#include <array>
#include <cstddef>

#include "uplift/model/model.h"

namespace uplift {

struct InterfaceFacts;

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
  // joint. The water of other joints is no weight.
  Thrust weight;
  double lateral() const;  // N m: of the others, about the reference point
};
ConstantLoads constant_loads(const Model& model, const Interface& interface, const InterfaceFacts& facts);

}  // namespace uplift
