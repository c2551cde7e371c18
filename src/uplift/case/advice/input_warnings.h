#pragma once
#include <string>
#include <vector>

#include "uplift/case/case.h"

namespace uplift {

/// Numbers that an engineer hardly means: friction of an angle in degrees, a weight or a damping in another unit, a structure of
/// millimetres, a base that carries next to nothing; functions of time that jump to zero before the run ends.
void warn_input(const Case& read, const RunSpec& spec, const BuiltCase& built, std::vector<std::string>& said);

}  // namespace uplift
