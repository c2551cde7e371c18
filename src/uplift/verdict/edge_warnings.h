#pragma once
#include <string>
#include <vector>

#include "uplift/verdict/numbers.h"

namespace uplift {

/// What the pressures at the edge of a base are worth: none of a rigid base that opens on constraints, where one point carries the edge;
/// few points in contact at the largest uplift.
std::vector<std::string> edge_warnings(const BuiltCase& built, const VerdictNumbers& numbers);

}  // namespace uplift
