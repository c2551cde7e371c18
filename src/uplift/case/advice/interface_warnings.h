#pragma once
#include <string>
#include <vector>

#include "uplift/case/case.h"

namespace uplift {

/// What is doubtful about interfaces and foundations: gaps, sides, closure stresses, capacities, cuts.
void warn_interfaces(const Case& read, const BuiltCase& built, std::vector<std::string>& said);

}  // namespace uplift
