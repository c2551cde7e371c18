#pragma once
#include "uplift/verdict/numbers.h"

namespace uplift {

/// Numbers of every envelope of the run; `bonded` may be null.
std::vector<BeamVerdict> beam_verdicts(const RunResult& run, const RunResult* bonded);
/// The largest of the recorded storey shears and drift ratios, where there are any; in space those of every storey, too.
void add_storeys(const BuiltCase& built, const RunResult& run, const RunResult* bonded, VerdictNumbers& numbers);

}  // namespace uplift
