#pragma once
#include "uplift/verdict/numbers.h"

namespace uplift {

/// Holds a criterion against the numbers: one result for the run, or for each interface that it is for.
void add_results(const Criterion& criterion, VerdictNumbers& numbers);

}  // namespace uplift
