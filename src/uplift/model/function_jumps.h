#pragma once
#include <memory>
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

/// A bend of a function, where its rate jumps.
struct FunctionBend {
  double time = 0;        // s
  double change = 0;      // of the rate [1/s]
  double half_width = 0;  // s, over which the pulse of the acceleration is spread to either side; 0: not known yet
};
/// The bends of a function in closed form, and those at the ends of a table, whose acceleration does not hold them.
std::vector<FunctionBend> bends_of(const TimeFunction& function);
std::vector<FunctionBend> bends_of_table(const TimeFunction& function);
/// The function with a pulse of the acceleration at each bend, a triangle over `half_width` [s] to either side. At steps of this length its
/// trapezoidal sum is the change of the rate, wherever the bend is between them.
std::shared_ptr<const TimeFunction> with_pulses(std::shared_ptr<const TimeFunction> function, std::vector<FunctionBend> bends);

}  // namespace uplift
