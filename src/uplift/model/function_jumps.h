#pragma once
#include <vector>

#include "uplift/model/function.h"

namespace uplift {

/// A function given by points that is zero outside of them, and not zero at the first or the last one.
struct FunctionJump {
  double time = 0;               // s
  double before = 0, after = 0;  // its values
};
/// The jumps of a function of the catalog, in the order of time; those of closed form have none here.
std::vector<FunctionJump> jumps_of(const TimeFunction& function);

}  // namespace uplift
