#pragma once
#include <optional>

#include "uplift/base/declare.h"

namespace uplift {

/// Numbers that the program wants to know of a law, a cone or the model of a foundation besides what these do; nothing: not stated.
struct StatedNumbers {
  std::optional<double> friction;           // coefficient
  std::optional<double> cohesion;           // Pa
  std::optional<double> friction_angle;     // rad, of a foundation
  std::optional<double> dashpot;            // Pa s/m
  std::optional<double> service, ultimate;  // N: V_s and V_u of a foundation
};
StatedNumbers stated_numbers(const Values& behaviour);

}  // namespace uplift
