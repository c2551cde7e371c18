#pragma once
#include <string>
#include <vector>

#include "uplift/verdict/numbers.h"

namespace uplift {

/// What the pressures at the edge of a base are worth: none of a rigid base that opens on constraints, where one point carries the edge;
/// few points in contact at the largest uplift.
std::vector<std::string> edge_warnings(const BuiltCase& built, const VerdictNumbers& numbers);

/// What section forces of beams are worth under impacts of constraints with damping in proportion to the stiffness (beta > 0): the jump of
/// the velocities has a damping force that grows as the step falls. Empty: no such impacts, or no beam with an envelope.
std::string damped_impacts(const BuiltCase& built, const VerdictNumbers& numbers, double beta);

}  // namespace uplift
