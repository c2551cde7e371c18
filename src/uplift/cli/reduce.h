#pragma once
#include "uplift/cli/commands.h"
#include "uplift/session/reduce.h"

namespace uplift::cli {

/// Makes a reduced model of a case; options.out is its file.
int reduce(const Options& options, const ReduceOptions& wanted);

}  // namespace uplift::cli
