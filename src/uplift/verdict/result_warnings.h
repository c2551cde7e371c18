#pragma once
#include <string>
#include <vector>

#include "uplift/verdict/numbers.h"

namespace uplift {

/// What the user should know of a run that is over, beyond its verdict: its static equilibrium is one of several; the forces of the whole
/// model are not in equilibrium; the scheme lost much energy; largest values are reached in the last tenth of the run, so that a longer one
/// may exceed them.
std::vector<std::string> result_warnings(const RunResult& run, const VerdictNumbers& numbers);

}  // namespace uplift
