#pragma once
#include "uplift/session/reduce.h"

namespace uplift {

/// Runs of a case with the whole model and with its reduced one under motions drawn at random, and how far they are apart. Whole runs of
/// large models march side by side, sixteen at a time. When it is stopped: of the pairs of runs that were made by then, perhaps none.
ControlErrors control_errors(const LoadedCase& loaded, const ReducedModel& reduced, const ReduceOptions& options, const Control& control);

}  // namespace uplift
