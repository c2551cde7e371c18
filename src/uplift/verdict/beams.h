#pragma once
#include "uplift/verdict/numbers.h"

namespace uplift {

/// Numbers of every envelope of the run; `bonded` may be null.
std::vector<BeamVerdict> beam_verdicts(const RunResult& run, const RunResult* bonded);
/// The largest of the recorded storey shears and drift ratios, where there are any.
void add_storeys(const RunResult& run, const RunResult* bonded, std::vector<VerdictNumber>& numbers);

}  // namespace uplift
