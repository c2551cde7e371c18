#pragma once
#include "uplift/verdict/verdict.h"

namespace uplift {

/// What a run of static stages alone says: how the structure stands at their end. There is nothing over time, and no bonded run beside:
/// what the base carries under the weight hardly depends on what it could carry in tension.
Verdict judge_standing(const BuiltCase& built, const RunResult& run);

}  // namespace uplift
