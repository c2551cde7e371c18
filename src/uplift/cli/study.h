#pragma once
#include <string>

#include "uplift/cli/commands.h"

namespace uplift::cli {

/// Writes NAME.study/plan.toml.
int new_study(const std::string& name);
/// What a study would compute, from its plan and one run.
int check_study(const Options& options);

}  // namespace uplift::cli
