#pragma once
#include <cmath>

#include "uplift/laws/law.h"
#include "uplift/math/lanes.h"

// The joint's part of the scheme of filtered energy decay (docs/theory, section 3). With the opening increment d of the step and what the
// filter remembers, d_f, a point that is in contact at the start of the step has, besides the path average t of its law, the traction
//     y = c (d - d_f)      c = b * stiffness at the start of the step [Pa/m]
// as far as it adds neither tension to a law without tension nor shear beyond the bound of friction. A point that is open at the start
// takes the traction at the end of the step where that dissipates: (t_end - t) d >= 0. Both terms only dissipate, and both vanish to second
// order in smooth motion.
namespace uplift {

/// Changes a normal traction and its slope with respect to the end of the path, as numbers or as lanes, from the path average of the law to
/// that with the filter. `end`, `end_slope`: at the end of the step; `increment`: opening increment; `tension`: the law carries tension;
/// `rises`: its traction never falls with the opening, so that the traction at the end always dissipates.
template <class Number>
[[gnu::always_inline]] inline void filter_normal(Number& value, Number& slope, Number end, Number end_slope, Number increment,
                                                 Number coefficient, Number lag, bool tension, bool rises) {
  const Number zero = 0;
  const auto open = coefficient < zero;
  Number closed = value + coefficient * (increment - lag), closed_slope = slope + coefficient;
  if (!tension) {
    const auto cut = closed > zero;
    closed = choose(cut, zero, closed), closed_slope = choose(cut, zero, closed_slope);
  }
  if (!rises) {
    const auto jumps = (end - value) * increment >= zero;
    end = choose(jumps, end, value), end_slope = choose(jumps, end_slope, slope);
  }
  value = choose(open, end, closed), slope = choose(open, end_slope, closed_slope);
}

}  // namespace uplift
