#pragma once
#include "uplift/cli/commands.h"
#include "uplift/session/reduce.h"

namespace uplift::cli {

/// Makes a reduced model of a case; options.out is its file. `model`: the file of a reduced model of the same structure, which gets control
/// runs instead; empty: none.
int reduce(const Options& options, const std::string& model, const ReduceOptions& wanted);

}  // namespace uplift::cli
