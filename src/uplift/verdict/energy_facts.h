#pragma once
#include "uplift/verdict/verdict.h"

namespace uplift {

/// Adds the facts and the paragraph of the energy balance: what the computation created, what the scheme lost, where the energy went.
void say_energy(const BuiltCase& built, const RunResult& run, Verdict& verdict);

}  // namespace uplift
